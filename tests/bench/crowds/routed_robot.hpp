// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "agents/navigation/route_planner.hpp"
#include "common/config/scenario.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// A robot that follows the shortest route to each of its goals, one after another, and comes to rest at
/// each. A robot without a goal wants to stay at its start.
class RoutedRobot {
 public:
  /// All arguments must outlive this object.
  RoutedRobot(const RobotSpec& spec, double goal_tolerance_m, const FloorRules& rules,
              const NamedPlanner& planner, const ObstacleWorld& world);

  const RobotSpec& spec() const { return spec_; }
  const State& state() const { return state_; }
  /// The limits of the motion, with the speed limit of the present goal.
  const MotionLimits& limits() const { return limits_; }
  /// When the robot came to rest at its last goal; nullopt if it is not at rest there.
  std::optional<double> settled_since_s() const { return settled_since_s_; }

  /// The velocity along the route if there were no other robots. It is as high as possible for a robot that
  /// brakes after one cycle and then stops at the end of the route. The robot rests if there is no route.
  [[nodiscard]] Vec2 preferred_mps(double cycle_s, Rng& rng);
  /// Moves the robot with a constant acceleration during a cycle that ends at `end_s`.
  void move(const Vec2& acceleration_mps2, double cycle_s, double end_s);

 private:
  void begin_goal();
  void update_arrival(double now_s);
  bool is_last_goal() const { return goal_ + 1 >= spec_.goals.size(); }

  const RobotSpec& spec_;
  double goal_tolerance_m_;
  MotionLimits floor_limits_;  // without the speed limits of goals
  MotionLimits limits_;
  RoutePlanner routes_;
  State state_;
  std::size_t goal_ = 0;
  Vec2 goal_m_{0, 0};
  std::optional<double> settled_since_s_;
};

}  // namespace sidestep
