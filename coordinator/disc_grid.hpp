// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

/// Spatial index of discs. Each disc is stored in the grid cell of its centre; discs larger than a cell are
/// kept in a separate list. Discs may lie anywhere, but the grid covers the field only.
class DiscGrid {
 public:
  /// Creates a grid for discs 0 .. count - 1, initially all absent.
  DiscGrid(const Field& field, std::size_t count);

  void set(std::uint32_t disc, const Circle& circle);
  void remove(std::uint32_t disc);
  /// Sets `found` to all discs that touch the circle, ascending.
  void find(const Circle& circle, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr std::uint32_t kNoCell = UINT32_MAX;
  std::size_t column_of(double x_m) const;
  std::size_t row_of(double y_m) const;

  Vec2 low_m_;
  double cell_m_;
  std::size_t columns_, rows_;
  std::vector<std::vector<std::uint32_t>> cells_;  // indexed by cell; the last one holds the larger discs
  std::vector<Circle> circles_;
  std::vector<std::uint32_t> cell_of_;
};

}  // namespace sidestep
