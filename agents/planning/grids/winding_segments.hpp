// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/planning/grids/grid_segment.hpp"

namespace sidestep {

/// A piece of a polygon's boundary.
struct WindingSegment {
  GridSegment segment;
  /// Number of polygons that cover the side above the segment, minus the number that cover the side below.
  std::int32_t winding = 0;
  auto operator<=>(const WindingSegment&) const = default;
};

/// Divides segments at their crossings, until they only have ends in common. Crossings are rounded to grid
/// points. This moves segments by about one grid unit and can cause new crossings, which are divided as well
/// (iterated snap rounding; Halperin and Packer 2002).
class CrossingDivider {
 public:
  /// Appends the boundary of a closed polygon with these corners. The polygon lies to the left of its edges.
  static void append_boundary(std::span<const GridPoint> corners, std::vector<WindingSegment>& segments);

  /// Returns false if crossings remain after many rounds.
  [[nodiscard]] bool divide(std::vector<WindingSegment>& segments);

 private:
  struct Cut {
    std::size_t segment = 0;
    std::int64_t along = 0;  // position along the segment, by which its cuts are sorted
    GridPoint at;
    auto operator<=>(const Cut&) const = default;
  };

  void find_cuts(const std::vector<WindingSegment>& segments);
  void compare(const std::vector<WindingSegment>& segments, std::size_t a, std::size_t b);
  void cut(const std::vector<WindingSegment>& segments, std::size_t i, const GridPoint& at);

  std::vector<Cut> cuts_;
  std::vector<WindingSegment> divided_;
};

}  // namespace sidestep
