// SPDX-License-Identifier: Apache-2.0
#include "tests/study/joint_planning/joint_check.hpp"

#include "agents/planning/joint/leg.hpp"
#include "tests/catch.hpp"

namespace sidestep::joint_check_test {

/// Two robots that drive past each other, 0.3 m apart, with a circle beside them.
struct Passing {
  Passing() {
    problem.field = {4, 2};
    problem.starts_m = {{-1, 0.15}, {1, -0.15}};
    problem.goals_m = {{1, 0.15}, {-1, -0.15}};
    for (std::size_t i = 0; i < 2; ++i)
      courses.push_back(course(problem.starts_m[i], problem.goals_m[i], problem.limits));
  }
  static Course course(const Vec2& from, const Vec2& to, const MotionLimits& limits) {
    Course result(Time{}, from);
    result.append(make_leg(Time{} + from_seconds(0.1), from, to, leg_times((to - from).norm(), limits)));
    return result;
  }
  std::string fault() const { return fault_of(problem, obstacles, courses, speed_limits_mps); }

  JointProblem problem;
  std::vector<Shape> obstacles{Circle{{0, 0.5}, 0.2}};
  std::vector<Course> courses;
  std::vector<double> speed_limits_mps;
};

TEST_CASE("robots that pass each other at a distance have no fault") { CHECK(Passing().fault() == ""); }

TEST_CASE("the check of joint plans names every kind of fault") {
  Passing close;
  close.problem.margin_m = 0.13;
  close.obstacles.clear();
  CHECK_THAT(close.fault(), StartsWith("robots 0 and 1 come too close after 0."));
  Passing circle;
  circle.obstacles = {Circle{{0, 0.5}, 0.25}};
  CHECK_THAT(circle.fault(), StartsWith("robot 0 comes too close to an obstacle"));
  Passing outside;
  outside.problem.field.width_m = 0.45;
  CHECK_THAT(outside.fault(), StartsWith("robot 0 leaves the field"));
  Passing elsewhere;
  elsewhere.problem.goals_m[1].x() += 1e-3;
  CHECK(elsewhere.fault() == "robot 1 does not end at its goal");
  elsewhere.problem.starts_m[0].x() += 1e-3;
  CHECK(elsewhere.fault() == "robot 0 does not begin at its start");
  Passing fast;
  fast.problem.limits.speed_mps = 1.9;
  CHECK_THAT(fast.fault(), StartsWith("robot 0 is too fast"));
  Passing forceful;
  forceful.problem.limits.acceleration_mps2 = 2.9;
  CHECK_THAT(forceful.fault(), StartsWith("robot 0 exceeds its acceleration"));
  Passing braking;
  braking.problem.limits.deceleration_mps2 = 4.9;
  CHECK_THAT(braking.fault(), StartsWith("robot 0 exceeds its acceleration"));
  Passing missing;
  missing.courses.pop_back();
  CHECK(missing.fault() == "not every robot has a course");
}

TEST_CASE("the check of joint plans respects the speed limits of single robots") {
  Passing limited;
  limited.speed_limits_mps = {2, 3};
  CHECK(limited.fault() == "");
  limited.speed_limits_mps = {2, 1.9};
  CHECK_THAT(limited.fault(), StartsWith("robot 1 is too fast"));
  limited.speed_limits_mps = {2};
  CHECK(limited.fault() == "not every robot has a speed limit");
  limited.speed_limits_mps = {3, 3};
  limited.problem.limits.speed_mps = 1.9;
  CHECK_THAT(limited.fault(), StartsWith("robot 0 is too fast"));
}

TEST_CASE("the check of joint plans reports a robot that jumps") {
  Passing jump;
  const Vec2 from(-0.9, 0.15), to = jump.problem.goals_m[0];
  Course course(Time{}, jump.problem.starts_m[0]);
  course.append(
      make_leg(Time{} + from_seconds(0.5), from, to, leg_times((to - from).norm(), MotionLimits{})));
  jump.courses[0] = course;
  CHECK_THAT(jump.fault(), StartsWith("robot 0 is too fast after 0.500 s"));
}

}  // namespace sidestep::joint_check_test
