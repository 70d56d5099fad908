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
/// happens after a touch is nobody's promise. A pair counts again only after it was apart by kApart_m. Pairs
/// that cannot meet before the next look at all of them are left out.
class Opponents {
 public:
  Opponents(std::span<const OpponentSpec> specs, double robot_radius_m, double robot_speed_limit_mps);

  /// Moves on by kPhysicsStep, and looks who touches whom.
  void step(std::span<const Body> robots);
  /// Robots have come, gone or been moved: whatever was near whom, it is looked for again.
  void search_again() { steps_to_next_search_ = 0; }

  bool empty() const { return discs_.empty(); }
  /// Where they are.
  std::span<const Circle> discs() const { return discs_; }
  const CrashTotals& totals() const { return totals_; }

  static constexpr double kApart_m = 0.02;
  static constexpr double kAtRest_mps = 0.05;

 private:
  struct Walk {
    std::vector<Vec2> path_m;
    double speed_mps;
    std::size_t next = 0;  ///< point of the way that it heads for
    bool is_round;
    bool is_going_back = false;
    Vec2 velocity_mps{0, 0};
  };
  struct Pair {
    std::uint32_t opponent;
    std::uint32_t robot;
    bool is_touching;
  };
  static void head_on(Walk& walk);
  static void move(Walk& walk, Vec2& position_m);
  void find_near(std::span<const Body> robots);
  void look_at(Pair& pair, const Body& robot);

  double radius_m_;
  double speed_limit_mps_;
  std::vector<Walk> walks_;
  std::vector<Circle> discs_;
  std::vector<Pair> near_;
  std::vector<Pair> touching_;
  int steps_to_next_search_ = 0;
  CrashTotals totals_;
};

}  // namespace sidestep
