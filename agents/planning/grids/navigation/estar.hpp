// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/planning/grids/navigation/bucket_queue.hpp"
#include "agents/planning/grids/navigation/cost_grid.hpp"
#include "agents/planning/grids/navigation/line_of_sight_distances.hpp"

namespace sidestep {

enum class GridKernel {
  kNf1,             ///< number of steps; a step leads to one of four neighbours
  kAlpha,           ///< linear interpolation
  kLsm,             ///< fast marching: nearly Euclidean
  kSecondOrderLsm,  ///< more accurate on open floor, but slower
  /// Exact lengths if all free cells have the same cost. Otherwise fast marching, bounded by exact lengths
  /// through cells with the goal's cost. Recomputes all these lengths when costs change.
  kLineOfSight,
};

struct EStarSettings {
  GridKernel kernel = GridKernel::kLsm;
  /// Cells whose centre is at most this far from the goal, and visible from it through cells of equal cost,
  /// have exact Euclidean distances; 0 to 20. Only for fast marching: NF1 and alpha begin with 0 in the
  /// goal's cell, and lines of sight need no such cells.
  int exact_radius_cells = 20;
};

/// E* (Philippsen 2004, EPFL thesis 3146, chapter 6): the cost of the cheapest path to the goal from every
/// cell of a grid, interpolated between cells. A robot reaches the goal by descending. When costs change,
/// only cells whose values change are recomputed. The result is bit-identical to a field computed from
/// scratch, because only one field satisfies the kernel (kernels.hpp). Does not allocate once warm.
///
/// Bookkeeping follows D* Lite (Koenig, Likhachev 2002): cells are expanded in the order of the lower of
/// their old and new values, and a cell that loses its support is raised before it can support others. But
/// while no cell waits to be raised, lower values are stored immediately, as in fast marching. And a raised
/// cell keeps the support of cells that were lower than it, whose values are final.
///
/// Throws std::invalid_argument for invalid settings, costs, cells and goals.
class EStar {
 public:
  explicit EStar(const CostGrid& grid, const EStarSettings& settings = {});

  /// Starts a new field. The goal must lie in the grid; a goal in a blocked cell cannot be reached.
  void set_goal(const Vec2& goal_m);
  /// Changes the cost of a cell. Values are out of date until they are propagated.
  void set_cost(GridCell cell, float cost);
  /// Updates all values that are out of date.
  void propagate();
  /// Updates values until this cell, all lower cells, and all cells that are at most `beyond` higher have
  /// final values; the rest can be updated later.
  void propagate_until(GridCell cell, float beyond = 0);

  const GridLayout& layout() const { return layout_; }
  const Vec2& goal_m() const { return goal_m_; }
  float cost(GridCell cell) const { return costs_[padded(cell)]; }
  bool is_blocked(GridCell cell) const { return cost(cell) == kBlocked; }
  /// The cost of the path from the cell's centre to the goal, in cells of cost 1; infinite if there is none.
  float value(GridCell cell) const { return values_[padded(cell)]; }
  /// The exact distance to the goal in cells, times the cost; infinite if the cell has no exact value.
  float exact_value(GridCell cell) const { return exact_at(padded(cell)); }
  /// For a cell whose value is exact: the first point to which the shortest path leads in a straight line.
  Vec2 exact_target_m(GridCell cell) const;
  /// For a cell whose value is exact: appends all turns of the shortest path, and the goal.
  void append_exact_path(GridCell cell, std::vector<Vec2>& path_m) const;
  /// The number of cells expanded since construction.
  std::uint64_t expansions() const { return expansions_; }

 private:
  using Entry = BucketQueue::Entry;
  /// The square of cells around the goal, including its last column and row.
  struct Square {
    std::uint32_t first_column = 0, last_column = 0, first_row = 0, last_row = 0;
  };

  // Cells are stored with a border of blocked cells: one column on each side, two rows below and above.
  std::uint32_t padded(GridCell cell) const { return cell + 2 * stride_ + 1 + 2 * (cell / layout_.columns); }
  void check_cell(GridCell cell) const;
  float exact_at(std::uint32_t at) const {
    const std::uint32_t i = at - exact_begin_;
    return i < exact_.size() ? exact_[i] : kBlocked;
  }
  bool is_euclidean() const;
  bool has_line_of_sight() const { return !line_of_sight_.empty(); }
  void compute_sight();
  bool is_in_disc(GridCell cell) const;
  float exact_distance(GridCell cell) const;
  void compute_exact_values();
  float key_of(Entry entry) const;
  /// The cell's value, or the value that it had before it lost its support.
  float known_value(std::uint32_t at) const { return std::min(values_[at], raised_from_[at]); }
  void mark_unsupported(std::uint32_t at);

  template <typename Kernel>
  auto neighbours_of(std::uint32_t at) const;
  template <typename Kernel, typename ValueOf>
  float value_from(std::uint32_t at, const ValueOf& value_of) const;
  template <typename Kernel>
  float value_from_neighbours(std::uint32_t at) const;
  template <typename Kernel>
  float value_from_lower(std::uint32_t at, float limit) const;
  template <typename Kernel>
  void lower(std::uint32_t at);
  template <typename Kernel>
  void lower_neighbours(std::uint32_t at);
  template <typename Kernel>
  void update(std::uint32_t at);
  template <typename Kernel>
  void update_neighbours(std::uint32_t at);
  template <typename Kernel>
  void raise(std::uint32_t at);
  template <typename Kernel>
  void apply_changes();
  template <typename Kernel>
  void expand_bucket();
  template <typename Kernel>
  void run(std::uint32_t until, float beyond);
  void run_kernel(std::uint32_t until, float beyond);

  GridLayout layout_;
  EStarSettings settings_;
  std::uint32_t stride_;
  std::vector<float> costs_, values_;  // with padding
  // With padding: for cells that wait to be raised, the value that was too low.
  std::vector<float> raised_from_;
  std::size_t unsupported_ = 0;
  BucketQueue queue_;
  std::vector<std::uint32_t> changed_;  // padded indices of cells whose cost or exact value has changed
  Vec2 goal_m_{0, 0};
  GridCell goal_ = 0;
  Square disc_;
  // Exact values of the padded rows around the goal; infinite where there is no exact value.
  std::vector<float> exact_;
  std::uint32_t exact_begin_ = 0;  // padded index of the first cell in exact_
  bool exact_is_stale_ = false;
  std::vector<LineOfSightDistances> line_of_sight_;  // one element or none
  // Whether all cells that are not blocked have the same cost; used only with lines of sight.
  bool has_uniform_cost_ = true;
  std::uint64_t expansions_ = 0;
};

}  // namespace sidestep
