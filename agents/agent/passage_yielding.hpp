// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "agents/agent/assignment.hpp"
#include "agents/agent/observations.hpp"
#include "agents/agent/route_to_target.hpp"
#include "agents/navigation/give_way.hpp"

namespace sidestep {

/// Decides whether a robot leaves a passage for another robot: a robot that makes no progress, or an idle
/// one. Robots are idle that have arrived or have no order; they go out of the way of every robot that waits.
/// Inputs: the versions and orders of the robots nearby, and the robot's own order and route. Output: the
/// place where the robot goes instead of its goal.
class PassageYielding {
 public:
  /// `rules` must outlive this object.
  PassageYielding(RobotId self, const FloorRules& rules);

  /// Call it once per planning. `home_m`: where the robot rests if it is idle and in nobody's way.
  void update(Time now, const Vec2& home_m, Observations& observations, const Assignment& assignment,
              RouteToTarget& route, Rng& rng);
  /// Measures the robot's progress from the length of a new route to its target.
  void on_route(const Route& route);
  /// Forgets the place, because the robot has another goal or its clock was set back.
  void restart(Time now) {
    give_way_.restart(now);
    pause_ = {};
    ignored_until_ = {};
    stays_.clear();
    waiting_.clear();
  }

  /// The place where the robot should go instead of its goal; nullopt if it should go to its goal.
  std::optional<Vec2> place_m() const { return give_way_.place_m(); }
  /// Whether the robot has arrived or has no order.
  bool is_idle() const { return is_idle_; }
  /// The robot for which this robot waits at that place; nullopt if it does not give way.
  std::optional<Blockage> blockage() const;

 private:
  /// The robots to which this robot may have to give way.
  std::vector<OtherRobot> others_in_passages(Time now, Observations& observations,
                                             const Assignment& assignment) const;
  OtherRobot other_nearby(const Version& version, Time now, const Assignment& assignment) const;
  void search(Time now, Rng& rng);
  /// Whether a robot knows no way to its target.
  static bool has_no_way(const Version& version);
  /// Whether a robot that knows no way to its target has another place to go. If it is idle, it makes room
  /// for others.
  static bool is_leaving(const Version& version);
  /// Whether this robot lets an idle one out that makes room for others.
  bool lets_out(const Version& version, Time now) const;
  /// Whether another robot without an order wants to come back to where this idle robot rests.
  bool wants_place_of_this_robot(const Version& version) const;
  /// Finds the robots that wait: they have an order to drive, or have no way back to their places, and stay
  /// where they are.
  void find_waiting(Time now, Observations& observations, const Assignment& assignment);
  bool waits(RobotId robot) const { return std::ranges::find(waiting_, robot) != waiting_.end(); }
  /// Whether a robot is within page_horizon_m().
  bool is_near(const Version& version, const Observations& observations) const;
  /// How far away the robot notices others.
  double view_m() const;

  RobotId self_;
  const FloorRules& rules_;
  Duration passage_period_;  // how long a robot has the right of way in a passage
  GiveWay give_way_;
  bool is_idle_ = false;
  Vec2 home_m_{0, 0};
  // An idle robot that stepped aside in vain does not do so again before this time.
  Time paused_until_{};
  Duration pause_{};
  Time ignored_until_{};  // until then this robot, if it has an order, lets no idle robots out
  /// A robot that may be waiting, and since when it has been near a place.
  struct Stay {
    RobotId robot;
    Vec2 place_m;
    Time since;
  };
  std::vector<Stay> stays_;
  std::vector<RobotId> waiting_;
  Time looked_at_{};  // when waiting_ was determined
  // Remaining length of the last route; infinite if it does not lead to the goal.
  double remaining_to_goal_m_ = 0;
};

}  // namespace sidestep
