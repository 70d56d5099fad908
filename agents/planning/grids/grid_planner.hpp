// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// The order in which cells are expanded.
enum class GridOrder {
  kBreadthFirst,  ///< finds a path with the fewest steps
  kDepthFirst,    ///< finds any path
  kAStar,         ///< finds the shortest path on the grid; the heuristic is the straight distance
};

struct GridSettings {
  GridOrder order = GridOrder::kAStar;
};

/// Search on a regular 8-connected grid whose origin is chosen so that the start is the centre of a cell.
/// Motions between cells are checked exactly. PlanReason::kUnreachable applies to this grid only.
class GridPlanner {
 public:
  explicit GridPlanner(const GridSettings& settings = {}) : settings_(settings) {}

  /// The result belongs to this planner and is valid until its next plan. Deterministic.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  /// The motions by which the last search reached cells.
  std::vector<Segment> steps() const;

 private:
  using Cell = std::uint32_t;
  struct Open {
    double estimate_m, cost_m;
    Cell cell, from;
  };

  void lay_out(const DiscDomain& domain, const Vec2& start);
  Vec2 position_of(Cell cell) const;
  void search(const DiscDomain& domain, const Budget& budget);
  void expand(const DiscDomain& domain, const Open& at);
  void push(const Open& open);
  Open pop();
  void write_plan(Cell cell);

  GridSettings settings_;
  Vec2 origin_m_{0, 0}, start_m_{0, 0}, goal_m_{0, 0};
  Cell columns_ = 0, rows_ = 0, start_ = 0;
  std::vector<Cell> came_from_;
  std::vector<Open> open_;  // a heap, a stack, or a queue that starts at queue_head_
  std::size_t queue_head_ = 0;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
