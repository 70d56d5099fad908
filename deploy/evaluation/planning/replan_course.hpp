// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/evaluation/planning/worlds.hpp"

namespace sidestep {

/// What a plan may cost in a cycle, in whatever time.
inline const Budget kReplanBudget{.nodes = 2000, .samples = 20'000};

/// What planners are asked when everything moves: the benchmark's 64 circles go straight to and fro, and a
/// robot drives the shortest way among them, from goal to goal. Whatever planner is measured, a seed's
/// questions are the same.
class ReplanCourse {
 public:
  static constexpr double kCycle_s = 1.0 / 60, kSpeed_mps = 2, kObstacleSpeed_mps = 0.5;

  /// `cycles`: how many steps will be made, at most.
  ReplanCourse(std::size_t cycles, std::uint64_t seed);

  /// Moves everything on by a cycle; comes before the first question.
  void step();

  /// This cycle's question; until the next step.
  DiscDomain domain() const;
  const Vec2& start_m() const { return at_m_; }
  /// The shortest way, if there is one.
  const Plan<Vec2>& shortest() const { return way_; }
  /// By distances, as is_valid_way does, but for a way that begins in an obstacle.
  bool is_valid(const std::vector<Vec2>& path_m) const;

 private:
  void move_circles();

  PlanWorld world_;
  ObstacleWorld obstacles_;
  std::vector<Vec2> velocities_mps_;
  LazyVisibility driver_;
  Plan<Vec2> way_;
  Vec2 at_m_;
  std::size_t goal_ = 0;
};

}  // namespace sidestep
