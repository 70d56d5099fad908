// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/domain/plan.hpp"

namespace sidestep {

/// In which order a grid's cells are looked at.
enum class GridOrder {
  kBreadthFirst,  ///< the fewest steps
  kDepthFirst,    ///< any way
  kAStar,         ///< the shortest way on the grid, with the straight distance as the bound
};

struct GridSettings {
  GridOrder order = GridOrder::kAStar;
  double cell_m = 0.1;
};

/// Search on a regular grid whose cells are joined with their eight neighbours, laid out from the start.
/// Motions from cell to cell are checked as all others; unreachable means on this grid.
class GridPlanner {
 public:
  explicit GridPlanner(const GridSettings& settings = {}) : settings_(settings) {}

  /// The result is this planner's, until its next plan. Nothing in it is random.
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng& rng);

  /// The motions by which the last plan came to cells.
  std::vector<Segment> steps() const;

 private:
  using Cell = std::uint32_t;
  struct Open {
    double promise_m, cost_m;
    Cell cell, from;
  };

  void lay_out(const DiscDomain& domain, const Vec2& start);
  Vec2 place_of(Cell cell) const;
  void search(const DiscDomain& domain, const Budget& budget);
  void look_round(const DiscDomain& domain, const Open& at);
  void put(const Open& open);
  Open take();
  void write_plan(Cell cell);

  GridSettings settings_;
  Vec2 corner_m_{0, 0}, start_m_{0, 0}, goal_m_{0, 0};
  Cell columns_ = 0, rows_ = 0, start_ = 0;
  std::vector<Cell> came_from_;
  std::vector<Open> open_;  // a heap, a stack, or a queue from `taken_`
  std::size_t taken_ = 0;
  Plan<Vec2> plan_;
};

}  // namespace sidestep
