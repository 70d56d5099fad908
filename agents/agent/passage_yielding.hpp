// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "agents/agent/assignment.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/route_to_target.hpp"
#include "agents/navigation/give_way.hpp"

namespace sidestep {

/// Decides whether a robot that makes no progress leaves a passage for another robot. Inputs: the versions
/// and orders of the robots nearby, and the robot's own order and route. Output: the place where the robot
/// goes instead of its goal.
class PassageYielding {
 public:
  /// `rules` must outlive this object.
  explicit PassageYielding(const FloorRules& rules);

  /// Call it once per planning.
  void update(Time now, Observations& observations, const Assignment& assignment, const RouteToTarget& route,
              Rng& rng);
  /// Measures the robot's progress from the length of a new route to its target.
  void on_route(const Route& route);
  /// Forgets the place, because the robot has another goal or its clock was set back.
  void restart(Time now) { give_way_.restart(now); }

  /// The place where the robot should go instead of its goal; nullopt if it should go to its goal.
  std::optional<Vec2> place_m() const { return give_way_.place_m(); }
  /// The robot for which this robot waits at that place; nullopt if it does not give way.
  std::optional<Blockage> blockage() const;

 private:
  /// The robots to which this robot may have to give way.
  std::vector<OtherRobot> others_in_passages(Time now, Observations& observations,
                                             const Assignment& assignment) const;
  OtherRobot other_nearby(const Version& version, Time now, const Assignment& assignment) const;

  const FloorRules& rules_;
  Duration passage_period_;  // how long a robot has the right of way in a passage
  GiveWay give_way_;
  // Remaining length of the last route; infinite if it does not lead to the goal.
  double remaining_to_goal_m_ = 0;
};

}  // namespace sidestep
