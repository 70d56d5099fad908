// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/batch/dispatch.hpp"
#include "common/motion/trajectory_bounds.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// What others may be executing, laid out for being found by place: a grid of cells, and in each the discs
/// that versions never leave. Allocates nothing once warm.
class TrajectoryIndex {
 public:
  explicit TrajectoryIndex(const batch::Kernels& kernels = batch::best_kernels()) : kernels_(&kernels) {}

  void clear();
  /// The version is read until clear() or assign().
  void add(const Version& version) { add(version, trajectory_bounds(version.trajectory)); }
  /// The same with the outline of its trajectory.
  void add(const Version& version, const TrajectoryBounds& outline);
  void assign(std::span<const Version> versions);

  std::size_t size() const { return versions_.size(); }
  const Version& version(std::size_t index) const { return *versions_[index]; }
  const TrajectoryBounds& outline(std::size_t index) const { return outlines_[index]; }

  /// Adds the indices of the versions whose discs, inflation_m larger, touch the circle. In no particular order,
  /// but the same one for the same versions added in the same order.
  void find(const Circle& circle, std::vector<std::uint32_t>& found);

 private:
  void build();
  std::size_t column_of(double x_m) const;
  std::size_t row_of(double y_m) const;
  void find_between(std::size_t begin, std::size_t end, const Circle& circle,
                    std::vector<std::uint32_t>& found);

  const batch::Kernels* kernels_;
  std::vector<const Version*> versions_;
  std::vector<TrajectoryBounds> outlines_;
  bool is_built_ = true;
  Vec2 low_m_{0, 0};
  double cell_m_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  double largest_m_ = 0;                          // radius of a disc
  std::vector<std::uint32_t> cell_of_;            // by version
  std::vector<std::uint32_t> first_of_cell_;      // and one more
  std::vector<std::uint32_t> order_;              // versions by cell, those of a row of cells side by side
  std::vector<batch::Row> x_m_, y_m_, radius_m_;  // in that order
  std::vector<std::uint8_t> masks_;
};

}  // namespace sidestep
