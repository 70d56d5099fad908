// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/trial/planning/worlds.hpp"

namespace sidestep {

/// Budget of one plan of a course, in counts instead of time, so that a seed gives the same plans on every
/// machine.
inline const Budget kReplanBudget{.nodes = 2000, .samples = 20'000};

/// A sequence of queries in a moving world: the benchmark's 64 circles move back and forth in straight lines,
/// and a robot drives along the shortest path among them, from goal to goal. The queries depend on the seed
/// alone, not on the planner that is measured.
class ReplanCourse {
 public:
  static constexpr double kCycle_s = 1.0 / 60, kSpeed_mps = 2, kObstacleSpeed_mps = 0.5;

  /// `cycles` is the maximum number of calls of step().
  ReplanCourse(std::size_t cycles, std::uint64_t seed);

  /// Advances the world by one cycle. Call it before the first query.
  void step();

  /// This cycle's query; valid until the next step.
  DiscDomain domain(const DiscDomainSettings& settings = {}) const;
  const Vec2& start_m() const { return position_m_; }
  /// The shortest path, if one exists.
  const Plan<Vec2>& shortest() const { return path_; }
  /// Like is_valid_path(), but a path that starts in an obstacle may be valid.
  [[nodiscard]] bool is_valid(const std::vector<Vec2>& path_m) const;

 private:
  void move_circles();

  PlanWorld world_;
  ObstacleWorld obstacles_;
  std::vector<Vec2> velocities_mps_;
  LazyVisibility driver_;
  Plan<Vec2> path_;
  Vec2 position_m_;
  std::size_t goal_ = 0;
};

}  // namespace sidestep
