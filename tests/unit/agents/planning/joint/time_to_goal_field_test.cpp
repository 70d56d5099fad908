// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/time_to_goal_field.hpp"

#include "agents/planning/joint/leg.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/planning/joint/random_course.hpp"

namespace sidestep::time_to_goal_field_test {

constexpr double kSpeed_mps = 2;

Box whole(const Field& field) {
  const Vec2 corner_m(field.length_m / 2, field.width_m / 2);
  return {-corner_m, corner_m};
}

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
    field.compute(whole(problem.field), goal_m, kSpeed_mps, {});
    const double expected_s = (at_m - goal_m).norm() / kSpeed_mps;
    CHECK(field.time_to_goal_s(at_m, 0) == Approx(expected_s).epsilon(0.04).margin(0.03));
    CHECK(field.time_to_goal_s(at_m, 7) == field.time_to_goal_s(at_m, 0));
  }
}

TEST_CASE("a robot in a door delays others until it has left") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  const SampledCourse other = leaving({0, 0}, {1.5, 0.8}, 40);
  const std::vector<TimedPositions> others{other.positions()};
  field.compute(whole(floor.problem.field), floor.goal_m, kSpeed_mps, others);
  const double early_s = field.time_to_goal_s({-0.5, 0}, 0), late_s = field.time_to_goal_s({-0.5, 0}, 4);
  CHECK(late_s == Approx(0.75).margin(0.1));
  CHECK(early_s > 2.4);
  CHECK(early_s < 3.2);
}

TEST_CASE("a robot that rests in the only door for good leaves no way to the goal") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  const SampledCourse other = resting({0, 0});
  const std::vector<TimedPositions> others{other.positions()};
  field.compute(whole(floor.problem.field), floor.goal_m, kSpeed_mps, others);
  CHECK(field.time_to_goal_s({-0.5, 0}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({0.5, 0}, 0) < 0.3);
}

TEST_CASE("a robot whose way is known only for a while delays others only for that time") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  const std::vector<Vec2> in_door_m(41, Vec2(0, 0));
  const std::vector<TimedPositions> others{{in_door_m, false}};
  field.compute(whole(floor.problem.field), floor.goal_m, kSpeed_mps, others);
  CHECK(field.time_to_goal_s({-0.5, 0}, 4) == Approx(0.75).margin(0.1));
  CHECK(field.time_to_goal_s({-0.5, 0}, 0) > 2.4);
}

TEST_CASE("positions outside the area never reach the goal, and those inside do so as on the whole floor") {
  const DoorFloor floor;
  TimeToGoalField part(floor.problem), all(floor.problem);
  part.compute({{-0.8, -0.5}, {1.3, 0.5}}, floor.goal_m, kSpeed_mps, {});
  all.compute(whole(floor.problem.field), floor.goal_m, kSpeed_mps, {});
  CHECK(part.time_to_goal_s({-1.2, 0}, 0) == TimeToGoalField::kNever_s);
  CHECK(part.time_to_goal_s({-0.6, 0.2}, 0) == Approx(all.time_to_goal_s({-0.6, 0.2}, 0)).margin(0.05));
}

TEST_CASE("positions outside the floor and in obstacles never reach the goal") {
  const DoorFloor floor;
  TimeToGoalField field(floor.problem);
  field.compute(whole(floor.problem.field), floor.goal_m, kSpeed_mps, {});
  CHECK(field.time_to_goal_s({-9, 0}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({9, 9}, 0) == TimeToGoalField::kNever_s);
  CHECK(field.time_to_goal_s({0, 0.6}, 0) == TimeToGoalField::kNever_s);
}

}  // namespace sidestep::time_to_goal_field_test
