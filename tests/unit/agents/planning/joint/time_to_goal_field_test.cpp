// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/time_to_goal_field.hpp"

#include "agents/planning/joint/leg.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::time_to_goal_field_test {

constexpr double kSpeed_mps = 2;

SampledCourse resting(const Vec2& at_m) { return {Course(Time{}, at_m), {at_m}}; }

/// Rests at a position for a number of samples, then drives straight to another position.
SampledCourse leaving(const Vec2& from_m, const Vec2& to_m, std::size_t rest_samples) {
  SampledCourse result{Course(Time{}, from_m), {}};
  result.samples_m.assign(rest_samples + 1, from_m);
  const Time start = Time{} + from_seconds(kCourseSample_s * static_cast<double>(rest_samples));
  const Trajectory leg = make_leg(start, from_m, to_m, leg_times((to_m - from_m).norm(), MotionLimits{}));
  result.course.append(leg);
  for (Time at = start; at < leg.end();) {
    at += from_seconds(kCourseSample_s);
    result.samples_m.push_back(leg.state_at(at).position_m);
  }
  return result;
}

//  +-----------+-----------+
//  |           |           |   A wall with a door for one robot.
//  |  A              goal  |
//  |           |           |
//  +-----------+-----------+
struct DoorFloor {
  DoorFloor() {
    problem.world = &world;
    problem.field = {4, 2};
  }
  ObstacleWorld world{{Box{{-0.05, -1}, {0.05, -0.15}}, Box{{-0.05, 0.15}, {0.05, 1}}}};
  JointProblem problem;
  Vec2 goal_m{1, 0};
};

TEST_CASE("without other robots the field is the distance over the speed limit, at all times") {
  const ObstacleWorld world;
  JointProblem problem;
  problem.world = &world;
  problem.field = {4, 3};
  TimeToGoalField field(problem);
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Vec2 goal_m = random_position(rng, 1.2), at_m = random_position(rng, 1.2);
    field.compute(goal_m, kSpeed_mps, {});
    const double expected_s = (at_m - goal_m).norm() / kSpeed_mps;
    CHECK(field.time_to_goal_s(at_m, 0) == Approx(expected_s).epsilon(0.04).margin(0.03));
    CHECK(field.time_to_goal_s(at_m, 7) == field.time_to_goal_s(at_m, 0));
  }
}

TEST_CASE("a robot in a door delays others until it has left") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  const SampledCourse other = leaving({0, 0}, {1.5, 0.8}, 40);
  const std::vector<const SampledCourse*> others{&other};
  field.compute(floor.goal_m, kSpeed_mps, others);
  const double early_s = field.time_to_goal_s({-0.5, 0}, 0), late_s = field.time_to_goal_s({-0.5, 0}, 4);
  CHECK(late_s == Approx(0.75).margin(0.1));
  CHECK(early_s > 2.4);
  CHECK(early_s < 3.2);
}

TEST_CASE("a robot that rests in the only door for good leaves no way to the goal") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  const SampledCourse other = resting({0, 0});
  const std::vector<const SampledCourse*> others{&other};
  field.compute(floor.goal_m, kSpeed_mps, others);
  CHECK(field.time_to_goal_s({-0.5, 0}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({0.5, 0}, 0) < 0.3);
}

TEST_CASE("positions outside the floor and in obstacles never reach the goal") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  field.compute(floor.goal_m, kSpeed_mps, {});
  CHECK(field.time_to_goal_s({-9, 0}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({9, 9}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({0, 0.6}, 0) == TimeToGoalField::kNever_s);
}

}  // namespace sidestep::time_to_goal_field_test
