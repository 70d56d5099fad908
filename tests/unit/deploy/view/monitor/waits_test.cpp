// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/waits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/view/monitor/straight_course.hpp"

namespace sidestep::waits_test {

using namespace std::chrono_literals;

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);
constexpr double kSeparation_m = 0.2, kReach_m = kSeparation_m + 0.05, kLimit_mps = 2;

PlannedRobot with(const DrivingCourse& course) {
  return {course.robot, &course, {}, std::numeric_limits<double>::infinity(), kLimit_mps};
}

PlannedRobot with(RobotId id, const Trajectory& version) { return {id, nullptr, version, 0, kLimit_mps}; }

//        ^ y
//        |    b: passes in half a second
//   0 ...a....|......>  x: robot 0 waits at the origin, and would be at a = (1, 0) in half a second
//             |
//             1
const DrivingCourse kWaiting = straight_course(0, kNow, 1s, {0, 0}, {2, 0}, 1s);
DrivingCourse crossing(RobotId robot, double x_m) {
  return straight_course(robot, kNow, 0s, {x_m, -1}, {0, 2}, 1s);
}

Waits waits_with(const std::vector<PlannedRobot>& robots) { return waits_among(robots, kSeparation_m, kNow); }

TEST_CASE("a robot that rests before a crossing waits for the robot that crosses, which waits for nobody") {
  const DrivingCourse first = crossing(1, 1);
  CHECK(waits_with({with(kWaiting), with(first)}) == Waits{{0, 1}});
  CHECK(waits_with({with(kWaiting)}).empty());
}

TEST_CASE("a robot waits for robots within the required separation and five centimetres") {
  for (const double x_m : {0.76, 1.24}) {
    const DrivingCourse near = crossing(1, x_m);
    CHECK(waits_with({with(kWaiting), with(near)}) == Waits{{0, 1}});
  }
  for (const double x_m : {0.74, 1.26}) {
    const DrivingCourse far = crossing(1, x_m);
    CHECK(waits_with({with(kWaiting), with(far)}).empty());
  }
}

TEST_CASE("a robot waits for the nearest of several robots") {
  const DrivingCourse left = crossing(1, 0.9), nearest = crossing(2, 1.05), right = crossing(3, 1.2);
  CHECK(waits_with({with(left), with(nearest), with(kWaiting), with(right)}) == Waits{{0, 2}});
}

TEST_CASE("a robot waits for a robot that has a version only") {
  CHECK(waits_with({with(kWaiting), with(7, Trajectory::resting(kNow, {1, 0.2}))}) == Waits{{0, 7}});
  CHECK(waits_with({with(kWaiting), with(7, Trajectory::resting(kNow, {1, 0.3}))}).empty());
}

TEST_CASE("a robot at its goal waits for nobody, unless it will continue") {
  DrivingCourse course = straight_course(0, kNow, 1s, {1, 0}, {0, 0}, 0s);
  const DrivingCourse other = crossing(1, 1);
  CHECK(waits_with({with(course), with(other)}).empty());
  course.continues = true;
  CHECK(waits_with({with(course), with(other)}) == Waits{{0, 1}});
}

TEST_CASE("a robot waits if it stands although its course drives") {
  const DrivingCourse course = straight_course(0, kNow, 0s, {0, 0}, {2, 0}, 1s), other = crossing(1, 1);
  PlannedRobot robot = with(course);
  robot.speed_mps = 1;
  CHECK(waits_with({robot, with(other)}).empty());
  robot.speed_mps = 0.01;
  CHECK(waits_with({robot, with(other)}) == Waits{{0, 1}});
}

TEST_CASE("a course that has not started yet is not taken for one that rests") {
  const DrivingCourse course = straight_course(0, kNow + 20ms, 0s, {0, 0}, {2, 0}, 1s);
  const DrivingCourse other = crossing(1, 1);
  CHECK(waits_with({with(course), with(other)}).empty());
}

/// Drives in random directions at random speeds, with pauses.
DrivingCourse random_course(Rng& rng, RobotId robot) {
  DrivingCourse course = straight_course(robot, kNow, 0s, {0, 0}, {0, 0}, 0s);
  const double x_m = rng.uniform(-1.5, 1.5);
  State state{{x_m, rng.uniform(-1.5, 1.5)}, {0, 0}};
  course.states.clear();
  course.continues = rng.below(2) == 0;
  for (std::uint64_t pieces = 1 + rng.below(6); pieces > 0; --pieces) {
    const double speed_mps = rng.below(3) == 0 ? 0 : rng.uniform(0, kLimit_mps);
    const double heading_rad = rng.uniform(-3, 3);
    state.velocity_mps = speed_mps * Vec2(std::cos(heading_rad), std::sin(heading_rad));
    for (std::uint64_t samples = 1 + rng.below(12); samples > 0; --samples) {
      course.states.push_back(state);
      state.position_m += to_seconds(DrivingCourse::kSample) * state.velocity_mps;
    }
  }
  course.states.push_back({state.position_m, {0, 0}});
  return course;
}

Vec2 position_at(const PlannedRobot& robot, Time t) {
  return robot.course ? robot.course->position_at(t) : robot.version->state_at(t).position_m;
}

/// The place ahead on a course, by steps of a millisecond.
Vec2 stepped_ahead(const DrivingCourse& course, Time t, double distance_m) {
  Vec2 place = course.position_at(t);
  for (; t < course.end() && distance_m > 0; t += 1ms) {
    const Vec2 next = course.position_at(t + 1ms);
    distance_m -= (next - place).norm();
    place = next;
  }
  return place;
}

TEST_CASE("waits agree with a comparison of all pairs, and with steps along the courses") {
  constexpr double kError_m = 0.005;
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
  INFO("seed " << seed);
  Rng rng(seed);
  int found = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<DrivingCourse> courses;
    for (RobotId id = 0; id < 15; ++id) courses.push_back(random_course(rng, id));
    const Time now = kNow + static_cast<int>(rng.below(400)) * 1ms;
    std::vector<PlannedRobot> robots;
    for (const DrivingCourse& course : courses) {
      const bool has_course = course.end() > now && rng.below(5) > 0;
      const Trajectory rest = Trajectory::resting(kNow, course.states.front().position_m);
      robots.push_back(has_course ? with(course) : with(course.robot, rest));
    }
    const Waits waits = waits_among(robots, kSeparation_m, now);
    for (const PlannedRobot& robot : robots) {
      CAPTURE(trial, robot.id);
      const auto wait = waits.find(robot.id);
      const bool waits_for_any = wait != waits.end();
      const bool is_slow = robot.course && robot.course->state_at(now).velocity_mps.norm() < kLimit_mps / 2;
      const bool is_there = robot.course && !robot.course->continues &&
                            (robot.course->goal_m() - robot.course->state_at(now).position_m).norm() < 0.05;
      if (!is_slow || is_there) {
        CHECK_FALSE(waits_for_any);
        continue;
      }
      const Vec2 ahead = stepped_ahead(*robot.course, now, kLimit_mps * 0.5);
      const auto distance_m = [&](const PlannedRobot& other) {
        return (position_at(other, now + 500ms) - ahead).norm();
      };
      double least_m = std::numeric_limits<double>::infinity();
      for (const PlannedRobot& other : robots)
        if (other.id != robot.id) least_m = std::min(least_m, distance_m(other));
      if (least_m < kReach_m - kError_m) REQUIRE(waits_for_any);
      if (least_m > kReach_m + kError_m) REQUIRE_FALSE(waits_for_any);
      if (!waits_for_any) continue;
      ++found;
      CHECK(wait->second != robot.id);
      CHECK(distance_m(robots[wait->second]) < least_m + 2 * kError_m);
    }
  }
  CHECK(found > 100);
}

}  // namespace sidestep::waits_test
