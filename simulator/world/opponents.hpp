// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "idl/monitor.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {

struct CrashTotals {
  std::uint64_t crashes = 0;               ///< number of times that a robot and an opponent began to touch
  std::uint64_t crashes_while_moving = 0;  ///< number of crashes in which the robot was not at rest
  /// Index of the robot in the latest crashes while moving: crash k is at k % MAX_CONTACTS.
  std::array<std::uint32_t, msg::MAX_CONTACTS> recent_moving_crashes{};
  double max_crash_speed_mps = 0;        ///< largest closing speed along the line of centres at a crash
  double max_robot_crash_speed_mps = 0;  ///< largest contribution of the robot to the closing speed
};

/// Opponents move on the floor without negotiating. Each follows its route back and forth, or in a loop if
/// the route ends where it begins, at constant speed. It ignores everything in its way. Crashes with robots
/// are counted but have no physical effect, since the protocol guarantees nothing about the motion after a
/// crash. A pair is counted again only after its clearance has exceeded kContactHysteresis_m. Between two
/// searches for neighbours, only pairs near enough to meet before the next search are checked.
class Opponents {
 public:
  Opponents(std::span<const OpponentSpec> specs, double robot_radius_m, double robot_speed_limit_mps);

  /// Advances by kPhysicsStep and counts crashes.
  void step(std::span<const Body> robots);
  /// Call when robots have been lifted, put down or moved: the next step searches for near pairs again.
  void invalidate_near_pairs() { steps_to_next_search_ = 0; }

  bool empty() const { return discs_.empty(); }
  /// The opponents at their current positions.
  std::span<const Circle> discs() const { return discs_; }
  const CrashTotals& totals() const { return totals_; }

  static constexpr double kContactHysteresis_m = 0.02;
  static constexpr double kAtRest_mps = 0.05;

 private:
  struct Route {
    std::vector<Vec2> waypoints_m;
    double speed_mps;
    std::size_t next_waypoint = 0;
    bool is_loop;
    bool is_reversed = false;
    Vec2 velocity_mps{0, 0};
  };
  struct Pair {
    std::uint32_t opponent;
    std::uint32_t robot;
    bool is_touching;
  };
  static void advance_waypoint(Route& route);
  static void follow(Route& route, Vec2& position_m);
  void find_near_pairs(std::span<const Body> robots);
  void check_pair(Pair& pair, const Body& robot);

  double radius_m_;
  double speed_limit_mps_;
  std::vector<Route> routes_;
  std::vector<Circle> discs_;
  std::vector<Pair> near_pairs_;
  std::vector<Pair> touching_pairs_;
  int steps_to_next_search_ = 0;
  CrashTotals totals_;
};

}  // namespace sidestep
