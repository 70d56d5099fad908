// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "agents/agent/neighbours.hpp"
#include "agents/agent/route_to_target.hpp"
#include "agents/navigation/deadlock_recovery.hpp"
#include "agents/navigation/local_driver.hpp"
#include "agents/navigation/steering.hpp"

namespace sidestep {

/// Chooses a robot's intent: where to head on its route, among robots and obstacles nearby. It steers around
/// the robots that have the right of way, turns aside in a deadlock, or leaves the choice to the local
/// methods of the robot's planner. Inputs: the robot's state, its route, the versions of nearby robots, and
/// after each search whether the desired motion was clear. Output: the intent.
class IntentPlanner {
 public:
  struct Query {
    State at_start;       ///< the robot's state at `start`
    Time start{};         ///< when the motion starts
    Route route;          ///< the next step of `routes`
    Duration max_hold{};  ///< maximum time for which an acceleration may be held
  };

  /// `rules` and `steering` must outlive this object. `steering` is working memory. `local`: the
  /// local methods of the robot's planner; nullopt if it has none.
  IntentPlanner(RobotId robot, const std::optional<LocalMethods>& local, const FloorRules& rules,
                Steering& steering);

  [[nodiscard]] Intent choose(const Query& query, const RouteToTarget& routes, Neighbours& neighbours);
  /// The accelerations that lead to the velocities that the local methods preferred in the last choice; empty
  /// without local methods. Valid until the next call.
  std::span<const Vec2> preferred_accelerations(const Vec2& velocity_mps, Duration hold);
  /// Processes the result of the search for the intent. `speed_mps` is the robot's speed.
  void on_search(const Intent& intent, bool desired_is_clear, double speed_mps, Time now);

  /// The robot has another goal, or its clock was set back: it is due at another time.
  void on_new_goal() { due_.reset(); }

  /// Whether the robot turns aside because it is blocked.
  bool is_recovering() const { return recovery_.is_active(); }
  /// Number of choices that did not continue the previous choice.
  std::uint64_t changes() const { return last_choice_.changes; }

 private:
  /// When the robot is due at its goal: at the time that it chose when it set out, or later if it is overdue.
  Time due(const Query& query);
  Intent steer(const Query& query, const RouteToTarget& routes, Neighbours& neighbours);
  /// Like steer(), but uses the planner's local methods. Fills preferred_mps_.
  Intent steer_locally(Query query, const RouteToTarget& routes, Neighbours& neighbours);
  /// Adds to the steering the nearby robots that this robot steers around.
  void add_robots(const Query& query, Neighbours& neighbours);
  /// Adds the obstacles near a position to the steering.
  void add_obstacles(const Vec2& position_m, const ZoneMap& zones);
  /// Adds to the steering the walls of the map that a robot at a position would see.
  void add_walls(const Vec2& position_m);
  /// The direction of the route, turned right by deadlock recovery as far as obstacles allow.
  Vec2 recovery_direction(const Query& query, const RouteToTarget& routes) const;

  const RobotId robot_;
  const std::optional<LocalMethods> local_;
  const FloorRules& rules_;
  Steering& steering_;
  DeadlockRecovery recovery_;
  LastChoice last_choice_;
  Time last_steered_start_{};
  std::optional<Time> due_;
  std::optional<LocalDriver> local_driver_;  // made when local_ is first used
  std::vector<Circle> bodies_nearby_;
  std::vector<Vec2> preferred_mps_, preferred_mps2_;  // chosen by the local methods in this cycle
};

}  // namespace sidestep
