// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/drive_state.hpp"

#include "tests/catch.hpp"

namespace sidestep::drive_state_test {

DriveGoal goal_at(double degrees, double distance_m = 2) {
  return {rotated(Vec2(distance_m, 0), degrees * std::numbers::pi / 180), std::nullopt, 0.1};
}

TEST_CASE(
    "a robot turns until the goal lies ahead, drives, and turns again if the goal is too far off its "
    "heading") {
  DriveState state = DriveState::kTurn;
  const auto next = [&](const DriveGoal& goal, double speed_mps) {
    return state = next_state(state, goal, speed_mps);
  };
  CHECK(next(goal_at(90), 0) == DriveState::kTurn);
  CHECK(next(goal_at(20), 0) == DriveState::kTurn);
  CHECK(next(goal_at(-9), 0) == DriveState::kGo);
  CHECK(next(goal_at(44), 0.5) == DriveState::kGo);
  CHECK(next(goal_at(46), 0.5) == DriveState::kAim);
  CHECK(next(goal_at(20), 0.3) == DriveState::kAim);
  CHECK(next(goal_at(9), 0.3) == DriveState::kGo);
  CHECK(next(goal_at(-60), 0.3) == DriveState::kAim);
  CHECK(next(goal_at(-60), 0) == DriveState::kTurn);
}

TEST_CASE("at the goal, a robot turns to the goal's heading and stops") {
  DriveGoal goal = goal_at(90, 0.05);
  CHECK(next_state(DriveState::kGo, goal, 0.3) == DriveState::kStop);
  goal.heading_rad = 1;
  CHECK(next_state(DriveState::kGo, goal, 0.3) == DriveState::kAlign);
  goal.heading_rad = 2 * std::numbers::pi + 0.1;
  CHECK(next_state(DriveState::kAlign, goal, 0) == DriveState::kStop);
  // The goal has moved.
  CHECK(next_state(DriveState::kStop, goal_at(90), 0) == DriveState::kTurn);
}

}  // namespace sidestep::drive_state_test
