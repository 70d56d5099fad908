// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_conflicts.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/driving_courses.hpp"

namespace sidestep::course_conflicts_test {

using namespace std::chrono_literals;

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);
constexpr double kSeparation_m = 0.2;

Vec2 slow_position_at(const DrivingCourse& course, Time t) {
  const double samples = to_seconds(t - course.start) / to_seconds(DrivingCourse::kSample);
  const double last = static_cast<double>(course.states.size() - 1);
  const double at = std::clamp(samples, 0.0, last), before = std::min(std::floor(at), last);
  const auto i = static_cast<std::size_t>(before);
  const Vec2& from_m = course.states[i].position_m;
  return from_m +
         (at - before) * (course.states[std::min(i + 1, course.states.size() - 1)].position_m - from_m);
}

/// Compares the robots at each sample of twenty seconds, or until the end of a course that will be continued.
std::optional<Time> slow_first_after(const DrivingCourse& a, const DrivingCourse& b, Time from) {
  const auto is_unknown = [](const DrivingCourse& course, Time t) {
    return course.continues && t > course.end();
  };
  for (int k = 0; k < 400; ++k) {
    const Time t = from + k * DrivingCourse::kSample;
    if (is_unknown(a, t) || is_unknown(b, t)) return std::nullopt;
    if ((slow_position_at(a, t) - slow_position_at(b, t)).norm() < kSeparation_m) return t;
  }
  return std::nullopt;
}

TEST_CASE("the first conflict of two courses is the first sample at which the robots are too close") {
  int conflicts = 0, free = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const DrivingCourse a = random_driving_course(3, kNow, rng), b = random_driving_course(8, kNow, rng);
    const Time last = std::max(a.end(), b.end());
    const Time from = last - from_seconds(rng.uniform(0, 3));
    const auto expected = slow_first_after(a, b, from);
    CourseConflicts conflicts_ab(kSeparation_m), conflicts_ba(kSeparation_m);
    CHECK(conflicts_ab.first_after(a, b, from) == expected);
    CHECK(conflicts_ba.first_after(b, a, from) == expected);
    ++(expected ? conflicts : free);
  }
  CHECK(conflicts > 300);
  CHECK(free > 500);
}

TEST_CASE("remembered conflicts equal those of a new search while time goes on or back and courses change") {
  constexpr RobotId kRobots = 4;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Rng rng(seed);
    CourseConflicts remembered(kSeparation_m);
    std::vector<DrivingCourse> courses;
    for (RobotId robot = 0; robot < kRobots; ++robot)
      courses.push_back(random_driving_course(robot, kNow, rng));
    Time now = kNow - 1s;
    for (int step = 0; step < 150; ++step) {
      CAPTURE(seed, step);
      // Searches from these times compare the robots at the same samples.
      now += (rng.chance(0.05) ? -10 : 1) * DrivingCourse::kSample;
      DrivingCourse& changed = courses[rng.below(kRobots)];
      const std::uint64_t change = rng.below(20);
      if (change == 0) changed = random_driving_course(changed.robot, now, rng);
      if (change == 1) changed.start += from_seconds(rng.uniform(0, 0.1));  // the robot was held back
      for (const DrivingCourse& a : courses)
        for (const DrivingCourse& b : courses) {
          if (a.robot == b.robot || rng.chance(0.3)) continue;
          if (now > std::max(a.end(), b.end())) continue;
          CAPTURE(a.robot, b.robot);
          REQUIRE(remembered.first_after(a, b, now) == slow_first_after(a, b, now));
        }
    }
  }
}

TEST_CASE("conflicts are remembered until they are over, whichever the cycle") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Rng rng(seed);
    CourseConflicts remembered(kSeparation_m);
    const DrivingCourse a = random_driving_course(1, kNow, rng), b = random_driving_course(2, kNow, rng);
    for (Time now = kNow; now < std::max(a.end(), b.end()); now += from_seconds(rng.uniform(0.005, 0.04))) {
      CAPTURE(seed, to_seconds(now - kNow));
      const auto first = remembered.first_after(a, b, now);
      if (!first) continue;
      CHECK(*first >= now);
      CHECK((slow_position_at(a, *first) - slow_position_at(b, *first)).norm() < kSeparation_m + 1e-12);
    }
  }
}

//  a ->->->-o.......... b crosses a's last place a second after a has arrived there.
//           ^
//           b
TEST_CASE("nobody conflicts with the last place of a course that its robot will continue from there") {
  DrivingCourse a = direct_course(1, kNow, {{-1, 0}, {0, 0}}, {0, 0});
  const DrivingCourse b = direct_course(2, kNow + 1s, {{0, -1}, {0, 0}}, {0, 1});
  CourseConflicts stays(kSeparation_m);
  const auto first = stays.first_after(a, b, kNow);
  REQUIRE(first);
  CHECK(*first > a.end());
  a.continues = true;
  CHECK_FALSE(CourseConflicts(kSeparation_m).first_after(a, b, kNow));
  CHECK_FALSE(CourseConflicts(kSeparation_m).first_after(b, a, kNow));
  CHECK_FALSE(CourseConflicts(kSeparation_m).first_after(a, b, a.end() + 10s));
}

TEST_CASE("a course that its robot will continue conflicts with others until it ends") {
  DrivingCourse a = direct_course(1, kNow, {{-1, 0}, {0, 0}}, {1, 0});
  const DrivingCourse b = direct_course(2, kNow, {{0, -1}, {0, 0}}, {0, 1});
  const auto first = CourseConflicts(kSeparation_m).first_after(a, b, kNow);
  REQUIRE(first);
  a.continues = true;
  CHECK(CourseConflicts(kSeparation_m).first_after(a, b, kNow) == first);
}

TEST_CASE("a course that its robot will continue conflicts with nobody from its end to the next sample") {
  DrivingCourse a = direct_course(1, kNow, {{-1, 0}, {0, 0}}, {0, 0});
  a.continues = true;
  DrivingCourse b = a;
  b.robot = 2;
  b.start = a.end();
  b.states = {{{1, 0}, {0, 0}}, {{0, 0}, {0, 0}}, {{0, 0}, {0, 0}}};
  CHECK_FALSE(CourseConflicts(kSeparation_m).first_after(a, b, a.end() - 5ms));
}

TEST_CASE("robots that rest too close to each other conflict even if their courses ended long ago") {
  const DrivingCourse a = direct_course(1, kNow, {{-1, 0}, {0, 0}}, {0, 0}),
                      b = direct_course(2, kNow, {{1, 0}, {0, 0}}, {0.1, 0});
  const Time later = std::max(a.end(), b.end()) + 10s;
  CHECK(CourseConflicts(kSeparation_m).first_after(a, b, later) == later);
}

TEST_CASE("conflicts of many robots are found even if there are too many to remember") {
  Rng rng(5);
  CourseConflicts conflicts(kSeparation_m);
  std::vector<DrivingCourse> courses;
  for (RobotId robot = 0; robot < 120; ++robot) courses.push_back(random_driving_course(robot, kNow, rng));
  for (int round = 0; round < 2; ++round)
    for (const DrivingCourse& a : courses)
      for (const DrivingCourse& b : courses) {
        if (a.robot >= b.robot) continue;
        CAPTURE(round, a.robot, b.robot);
        REQUIRE(conflicts.first_after(a, b, kNow - 1s) == slow_first_after(a, b, kNow - 1s));
      }
}

}  // namespace sidestep::course_conflicts_test
