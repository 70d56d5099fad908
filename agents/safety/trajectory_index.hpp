// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/batch/dispatch.hpp"
#include "common/motion/trajectory_bounds.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Spatial index of the versions that other robots may be executing. Cells of a grid hold the bounding discs
/// of the versions' trajectories. Allocates nothing once warm.
class TrajectoryIndex {
 public:
  explicit TrajectoryIndex(const batch::Kernels& kernels = batch::best_kernels()) : kernels_(&kernels) {}

  void clear();
  /// Stores a reference to the version, which must stay valid until clear() or assign().
  void add(const Version& version) { add(version, trajectory_bounds(version.trajectory)); }
  /// Like add(version), for a version whose bounds are already known.
  void add(const Version& version, const TrajectoryBounds& bounds);
  void assign(std::span<const Version> versions);

  std::size_t size() const { return versions_.size(); }
  const Version& version(std::size_t index) const { return *versions_[index]; }
  /// The bounds of the version's trajectory. The disc includes the version's inflation.
  const TrajectoryBounds& bounds(std::size_t index) const { return bounds_[index]; }

  /// Appends the indices of the versions whose discs touch the circle. Their order is unspecified but
  /// deterministic: it depends only on the versions and the order in which they were added.
  void find(const Circle& circle, std::vector<std::uint32_t>& found);

 private:
  void build();
  std::size_t column_of(double x_m) const;
  std::size_t row_of(double y_m) const;
  void find_between(std::size_t begin, std::size_t end, const Circle& circle,
                    std::vector<std::uint32_t>& found);

  const batch::Kernels* kernels_;
  std::vector<const Version*> versions_;
  std::vector<TrajectoryBounds> bounds_;
  bool is_built_ = true;
  Vec2 min_m_{0, 0};
  double cell_m_ = 1;
  std::size_t columns_ = 1, rows_ = 1;
  double max_radius_m_ = 0;
  std::vector<std::uint32_t> cell_of_;  // indexed by version
  // Indexed by cell: first index into order_; has one more entry than there are cells.
  std::vector<std::uint32_t> cell_begin_;
  std::vector<std::uint32_t> order_;              // indices of versions, sorted by cell in row-major order
  std::vector<batch::Row> x_m_, y_m_, radius_m_;  // coordinates and radii of discs, sorted like order_
  std::vector<std::uint8_t> masks_;
};

}  // namespace sidestep
