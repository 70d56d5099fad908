// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/circle.hpp"
#include "common/geometry/field.hpp"

namespace sidestep {

/// Discs that move now and then, to be found by place: each is kept in the cell of its centre, and those too
/// large for that on a list of their own. Discs may lie anywhere; the field is where most of them are.
class DiscGrid {
 public:
  /// For discs 0 .. count - 1, none of which is there yet.
  DiscGrid(const Field& field, std::size_t count);

  void set(std::uint32_t disc, const Circle& circle);
  void remove(std::uint32_t disc);
  /// Replaces `found` by all discs that touch the circle, ascending.
  void find(const Circle& circle, std::vector<std::uint32_t>& found) const;

 private:
  static constexpr std::uint32_t kNowhere = UINT32_MAX;
  std::size_t column_of(double x_m) const;
  std::size_t row_of(double y_m) const;

  Vec2 low_m_;
  double cell_m_;
  std::size_t columns_, rows_;
  std::vector<std::vector<std::uint32_t>> cells_;  // the last: discs that are too large
  std::vector<Circle> circles_;
  std::vector<std::uint32_t> cell_of_;
};

}  // namespace sidestep
