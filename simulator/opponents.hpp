// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/config/scenario.hpp"
#include "simulator/body.hpp"

namespace sidestep {

struct CrashTotals {
  std::uint64_t crashes = 0;         ///< robot and opponent began to touch
  std::uint64_t moving_crashes = 0;  ///< and the robot was not at rest
  double crash_speed_mps = 0;        ///< largest closing speed along the centre line at a touch
  double robot_crash_speed_mps = 0;  ///< largest share of the robot in it
};

/// Those who move on the floor without asking: each goes its way at its speed, whatever is in it, to and fro,
/// or round when the way ends where it begins. Counts their touches with robots, and pushes nobody: what
/// happens after a touch is nobody's promise. A pair counts again only after it was apart by kApart_m.
class Opponents {
 public:
  Opponents(std::span<const OpponentSpec> specs, std::size_t robots);

  /// Moves on by kPhysicsStep, and looks who touches whom.
  void step(std::span<const Body> robots, double robot_radius_m);

  bool empty() const { return discs_.empty(); }
  /// Where they are.
  std::span<const Circle> discs() const { return discs_; }
  const CrashTotals& totals() const { return totals_; }

  static constexpr double kApart_m = 0.02;
  static constexpr double kAtRest_mps = 0.05;

 private:
  struct Walk {
    std::vector<Vec2> way_m;
    double speed_mps;
    std::size_t next = 0;  ///< point of the way that it heads for
    bool is_round;
    bool is_going_back = false;
    Vec2 velocity_mps{0, 0};
  };
  static void head_on(Walk& walk);
  void move(Walk& walk, Vec2& position_m) const;
  void look_at(std::size_t opponent, std::size_t robot, const Body& body, double robot_radius_m);

  std::vector<Walk> walks_;
  std::vector<Circle> discs_;
  std::vector<bool> touching_;  ///< opponent by opponent, of all robots
  std::size_t robots_;
  CrashTotals totals_;
};

}  // namespace sidestep
