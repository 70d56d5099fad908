// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/agent/assignment.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/occluded_corners.hpp"
#include "agents/agent/route_obstacles.hpp"

namespace sidestep {

/// Finds the temporary obstacles that a route must avoid: people and other moving obstacles, displaced
/// robots, and robots at rest. For robots with lasers, also stationary obstacles that the rules do not
/// contain, and occluded corners. Inputs: the agent's observations, and the orders of other robots.
class RouteSurroundings {
 public:
  /// `rules` must outlive this object.
  explicit RouteSurroundings(const FloorRules& rules) : rules_(rules) {}

  /// The obstacles on the way to the target. `reaction` is the time from a scan to the robot's motion.
  std::vector<TemporaryObstacle> find(const Vec2& target_m, Time now, Observations& observations,
                                      const Assignment& assignment, const OccludedCorners& corners,
                                      Duration reaction) const;

 private:
  /// Obstacles that the laser sees but the rules do not contain, and corners that the robot cannot pass.
  std::vector<TemporaryObstacle> find_in_sight(const Vec2& target_m, const RobotLaser& laser,
                                               const OccludedCorners& corners, Duration reaction) const;
  /// The nearest moving obstacles, enlarged by their expected motion, but not so far that they cover the
  /// target.
  std::vector<Circle> find_moving(const Vec2& target_m, Time now, Observations& observations) const;
  /// Whether a robot at rest will not move away by itself.
  bool will_stay(const Neighbours::Stationary& other, const Assignment& assignment,
                 const Vec2& position_m) const;

  const FloorRules& rules_;
};

}  // namespace sidestep
