// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/course_search.hpp"

#include <cmath>

#include "agents/navigation/trapezoidal_profile.hpp"
#include "common/messaging/course_codec.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/navigation/driving_courses.hpp"

namespace sidestep::course_search_test {

using namespace std::chrono_literals;

constexpr Time kNow = time_from_ns(1'800'000'000'000'000'000);

FloorRules rules_on(const Field& field) {
  FloorRules rules;
  rules.field = field;
  return rules;
}

double time_alone_s(const CourseTask& task) {
  const Vec2 way_m = task.goal_m - task.at_start.position_m;
  return TrapezoidalProfile::duration_s(way_m.norm(), task.at_start.velocity_mps.norm(), task.limits);
}

/// A task of a robot that may already move towards its goal, and can stop there.
CourseTask random_straight_task(Rng& rng, double half_m) {
  CourseTask task;
  task.robot = static_cast<RobotId>(rng.below(100));
  task.at_start.position_m = random_vector(rng, half_m);
  task.goal_m = random_vector(rng, half_m);
  task.limits.speed_mps = rng.uniform(0.5, 2);
  const Vec2 way_m = task.goal_m - task.at_start.position_m;
  const double can_stop_mps = std::sqrt(2 * task.limits.deceleration_mps2 * way_m.norm());
  if (rng.chance(0.5))
    task.at_start.velocity_mps =
        rng.uniform(0, 0.99) * std::min(task.limits.speed_mps, can_stop_mps) * way_m.normalized();
  return task;
}

void check_arrives_in_time_alone(const DrivingCourse& course, const CourseTask& task) {
  const double alone_s = time_alone_s(task), course_s = to_seconds(course.end() - course.start);
  CHECK(course_s >= alone_s - 1e-6);
  CHECK(course_s < alone_s + to_seconds(DrivingCourse::kSample) + 1e-6);
  CHECK((course.goal_m() - task.goal_m).norm() < 1e-6);
  CHECK(course.states.back().velocity_mps == Vec2(0, 0));
  const TrapezoidalProfile profile((task.goal_m - task.at_start.position_m).norm(),
                                   task.at_start.velocity_mps.norm(), task.limits);
  for (std::size_t i = 0; i < course.states.size(); ++i) {
    CAPTURE(i);
    const double expected_mps =
        profile.velocity_after(to_seconds(DrivingCourse::kSample) * static_cast<double>(i));
    CHECK(course.states[i].velocity_mps.norm() == Approx(expected_mps).margin(1e-6));
  }
}

TEST_CASE("a course on a free floor is straight and takes the time of the trapezoidal profile") {
  const FloorRules rules = rules_on({6, 6});
  CourseSearch search(rules, ObstacleWorld());
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const CourseTask task = random_straight_task(rng, 2.5);
    const CourseObstruction nobody(kNow);
    const auto straight = search.find_straight(task, nobody);
    REQUIRE(straight);
    CHECK(straight->robot == task.robot);
    CHECK(straight->start == kNow);
    CHECK_FALSE(straight->continues);
    check_arrives_in_time_alone(*straight, task);
    const auto found = search.find(task, nobody, rng);
    REQUIRE(found);
    check_arrives_in_time_alone(*found, task);
  }
}

//  start ->    o    goal
TEST_CASE("a course around a resting robot keeps its distance and costs little time") {
  const FloorRules rules = rules_on({6, 4});
  CourseSearch search(rules, ObstacleWorld());
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CourseTask task;
    task.at_start.position_m = {rng.uniform(-2, -1.5), rng.uniform(-0.3, 0.3)};
    task.goal_m = {rng.uniform(1.5, 2), rng.uniform(-0.3, 0.3)};
    const double beside_m = rng.uniform(-0.15, 0.15), part = rng.uniform(0.3, 0.7);
    const Vec2 way_m = task.goal_m - task.at_start.position_m;
    const std::vector<Vec2> resting_m{task.at_start.position_m + part * way_m +
                                      beside_m * left_of(way_m.normalized())};
    CourseObstruction obstruction(kNow);
    obstruction.add_staying(resting_m);
    CHECK_FALSE(search.find_straight(task, obstruction));
    const auto course = search.find(task, obstruction, rng);
    REQUIRE(course);
    CHECK(nearest_m(*course, course_of(9, Trajectory::resting(kNow, resting_m[0])), kNow) >=
          rules.min_separation_m());
    CHECK((course->goal_m() - task.goal_m).norm() < 1e-6);
    CHECK(to_seconds(course->end() - kNow) < time_alone_s(task) + 0.4);
    for (const State& state : course->states) {
      CHECK(state.velocity_mps.norm() <= task.limits.speed_mps + 1e-6);
      CHECK(rules.field.contains(state.position_m, rules.radius_m));
    }
  }
}

TEST_CASE("slow robots find a course around a resting robot, too") {
  const double speed_mps = GENERATE(1.0, 0.5, 0.2);
  CAPTURE(speed_mps);
  CourseSearch search(rules_on({6, 4}), ObstacleWorld());
  Rng rng(1);
  CourseTask task;
  const double half_m = std::min(2.0, 0.5 * CourseSearch::reach_m(speed_mps));
  task.at_start.position_m = {-half_m, 0};
  task.goal_m = {half_m, 0};
  task.limits.speed_mps = speed_mps;
  CourseObstruction obstruction(kNow);
  obstruction.add_staying(std::vector<Vec2>{{0, 0.01}});
  const auto course = search.find(task, obstruction, rng);
  REQUIRE(course);
  CHECK(to_seconds(course->end() - kNow) < time_alone_s(task) + 1 / speed_mps);
}

TEST_CASE("a course keeps its distance from robots on their courses") {
  const FloorRules rules = rules_on({6, 6});
  CourseSearch search(rules, ObstacleWorld());
  int found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    CourseTask task;
    task.at_start.position_m = {-2, rng.uniform(-0.5, 0.5)};
    task.goal_m = {2, rng.uniform(-0.5, 0.5)};
    CourseObstruction obstruction(kNow);
    std::vector<DrivingCourse> others;
    for (RobotId robot = 1; robot <= 5; ++robot) {
      const double x = -1.8 + 0.6 * robot, start_s = rng.uniform(-0.5, 0.5);
      const double side = rng.chance(0.5) ? 1 : -1, far_m = rng.uniform(0.8, 2);
      others.push_back(direct_course(robot, kNow + from_seconds(start_s), {{x, -far_m * side}, {0, 0}},
                                     {x, far_m * side}));
      obstruction.add(others.back());
    }
    const auto course = search.find(task, obstruction, rng);
    if (!course) continue;
    ++found;
    for (const DrivingCourse& other : others) {
      CAPTURE(other.robot);
      CHECK(nearest_m(*course, other, kNow) >= rules.min_separation_m());
    }
  }
  CHECK(found > 35);
}

TEST_CASE("goals are within five metres, and within what the robot drives in five seconds") {
  CHECK(CourseSearch::reach_m(2) == 5);
  CHECK(CourseSearch::reach_m(0.5) == 2.5);
  CHECK(CourseSearch::reach_m(0) == 0);
}

TEST_CASE(
    "courses lead around a robot to all goals in reach on a large floor, wherever the robot has moved") {
  const Field field{40, 40};
  const FloorRules rules = rules_on(field);
  CourseSearch search(rules, ObstacleWorld());
  Vec2 robot_m(-8, 2);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Rng rng(seed);
    robot_m += random_vector(rng, seed % 4 == 0 ? 3 : 0.3);
    CourseTask task;
    task.at_start.position_m = robot_m;
    const double reach_m = CourseSearch::reach_m(task.limits.speed_mps);
    // On the border of the reach
    const double along_m = rng.uniform(-1, 1) * reach_m;
    task.goal_m = robot_m + (rng.chance(0.5) ? Vec2(along_m, reach_m) : Vec2(-reach_m, along_m));
    CAPTURE(seed, robot_m.x(), robot_m.y(), task.goal_m.x(), task.goal_m.y());
    CourseObstruction obstruction(kNow);
    obstruction.add_staying(std::vector<Vec2>{(robot_m + task.goal_m) / 2});
    const auto course = search.find(task, obstruction, rng);
    REQUIRE(course);
    CHECK((course->goal_m() - task.goal_m).norm() < 1e-6);
    for (const State& state : course->states) {
      const Vec2 way_m = (state.position_m - robot_m).cwiseAbs();
      CHECK(way_m.maxCoeff() < 6.6);
    }
  }
}

TEST_CASE("the fastest motion is found to goals beyond the surroundings") {
  CourseSearch search(rules_on({40, 8}), ObstacleWorld());
  CourseTask task;
  task.goal_m = {15, 1};
  CourseObstruction obstruction(kNow);
  const auto course = search.find_straight(task, obstruction);
  REQUIRE(course);
  check_arrives_in_time_alone(*course, task);
  // Another robot rests at the goal.
  obstruction.add_staying(std::vector<Vec2>{{15.1, 1}});
  CHECK_FALSE(search.find_straight(task, obstruction));
}

TEST_CASE("a course fits into a message, however far the goal is and however slow the robot") {
  CourseSearch search(rules_on({200, 8}), ObstacleWorld());
  CourseTask far, slow;
  far.at_start.position_m = {-90, 0};
  far.goal_m = {90, 0};
  slow.goal_m = {2, 0};
  slow.limits.speed_mps = 0.05;
  for (const CourseTask& task : {far, slow}) {
    CAPTURE(task.goal_m.x());
    const auto course = search.find_straight(task, CourseObstruction(kNow));
    CHECK((!course || course->states.size() <= DrivingCourse::kMaxStates));
  }
}

TEST_CASE("there is no course to another place for a robot that must not drive") {
  CourseSearch search(rules_on({6, 4}), ObstacleWorld());
  Rng rng(1);
  CourseTask task;
  task.goal_m = {2, 0};
  task.limits.speed_mps = 0;
  CHECK_FALSE(search.find_straight(task, CourseObstruction(kNow)));
  CHECK_FALSE(search.find(task, CourseObstruction(kNow), rng));
}

TEST_CASE("there is no course in the way of others for a robot that must not drive") {
  CourseSearch search(rules_on({6, 4}), ObstacleWorld());
  Rng rng(1);
  CourseTask task;
  task.goal_m = {2, 0};
  task.limits.speed_mps = 0;
  CourseObstruction obstruction(kNow);
  obstruction.add(direct_course(2, kNow, {{0, -1}, {0, 0}}, {0, 1}));
  CHECK_FALSE(search.find(task, obstruction, rng));
}

TEST_CASE("courses to be avoided are sampled from any time on") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    std::vector<DrivingCourse> courses;
    for (RobotId robot = 0; robot < 5; ++robot) courses.push_back(random_driving_course(robot, kNow, rng));
    const Time from = kNow + from_seconds(rng.uniform(-1, 3));
    CourseObstruction obstruction(from);
    for (const DrivingCourse& course : courses) obstruction.add(course);
    REQUIRE(obstruction.others().size() == courses.size());
    for (std::size_t i = 0; i < courses.size(); ++i) {
      const TimedPositions& sampled = obstruction.others()[i];
      CHECK(sampled.stays != courses[i].continues);
      for (std::size_t k = 0; k < 120; ++k) {
        CAPTURE(i, k);
        const Time t = from + DrivingCourse::kSample * static_cast<std::int64_t>(k);
        CHECK((sampled.at(k) - courses[i].position_at(t)).norm() < 1e-12);
        if (t <= courses[i].end()) CHECK(sampled.is_known(k));
        if (t >= courses[i].end() + DrivingCourse::kSample && k > 0)
          CHECK(sampled.is_known(k) != courses[i].continues);
      }
    }
  }
}

TEST_CASE("robots that stay are avoided for ever, and robots that leave only for a moment") {
  CourseSearch search(rules_on({6, 4}), ObstacleWorld());
  CourseTask task;
  task.at_start.position_m = {-2, 0};
  task.goal_m = {2, 0};
  const std::vector<Vec2> far_m{{1, 0}}, near_m{{-1.75, 0}};
  CourseObstruction stays(kNow), leaves(kNow), leaves_near(kNow);
  stays.add_staying(far_m);
  leaves.add_leaving(far_m);
  leaves_near.add_leaving(near_m[0]);
  CHECK_FALSE(search.find_straight(task, stays));
  CHECK(search.find_straight(task, leaves));
  CHECK_FALSE(search.find_straight(task, leaves_near));
}

TEST_CASE("a course keeps its distance from obstacles, and none is found if they enclose the robot") {
  Rng rng(1);
  const FloorRules rules = rules_on({6, 4});
  CourseTask task;
  task.at_start.position_m = {-2, 0};
  task.goal_m = {2, 0};
  const ObstacleWorld wall{{Box{{-0.05, -1.4}, {0.05, 1.4}}}};
  CourseSearch around(rules, wall);
  const CourseObstruction nobody(kNow);
  CHECK_FALSE(around.find_straight(task, nobody));
  const auto course = around.find(task, nobody, rng);
  REQUIRE(course);
  for (Time t = kNow; t <= course->end(); t += 1ms)
    CHECK_FALSE(wall.touches(course->state_at(t).position_m, rules.radius_m + rules.margin_m));
  CourseSearch enclosed(rules, ObstacleWorld{{Box{{-0.05, -2}, {0.05, 2}}}});
  CHECK_FALSE(enclosed.find(task, nobody, rng));
}

}  // namespace sidestep::course_search_test
