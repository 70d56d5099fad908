// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "agents/planning/grids/grid_segment.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The trapezoidal map of segments, with a search structure for point location (de Berg et al. 2008, chapter
/// 6). From each end of a segment, walls extend up and down to the next segments; they divide the plane into
/// trapezoids. Segments are inserted in random order, so for any set of segments building takes O(n log n)
/// expected time, and locating a point O(log n). Reuses its memory.
class TrapezoidalMap {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0xffffffffu;

  /// A trapezoid is bounded by two segments, and by walls through two ends of segments. It has no width if
  /// both ends have the same x: walls are infinitesimally sheared.
  struct Trapezoid {
    Index bottom = kNone, top = kNone;  ///< indices of segments
    GridPoint left, right;              ///< the segment ends that cause its walls
    /// The neighbours behind each wall: first the neighbour with the same bottom segment, then the neighbour
    /// with the same top segment; kNone if there is none.
    std::array<Index, 2> left_neighbours{kNone, kNone}, right_neighbours{kNone, kNone};
    Index leaf = kNone;  ///< leaf in the search structure; kNone for unused trapezoids
  };
  struct Location {
    Index trapezoid;
    std::size_t steps;  ///< number of comparisons
  };

  /// Segments may only have ends in common, and must lie within the box from -half to half. Throws
  /// std::invalid_argument if they exceed the box, or if it detects a crossing. The random numbers determine
  /// the search structure and the order of trapezoids, not the trapezoids themselves.
  void build(std::span<const GridSegment> segments, const GridPoint& half, Rng& rng);

  /// Finds the trapezoid at a point of the box. A point on a segment belongs to the trapezoid above it.
  Location locate(const GridPoint& point) const;

  /// The segments, then the bottom and the top of the box.
  const std::vector<GridSegment>& segments() const { return segments_; }
  Index box_bottom() const { return static_cast<Index>(segments_.size() - 2); }
  Index box_top() const { return static_cast<Index>(segments_.size() - 1); }
  /// All trapezoids, including unused ones.
  const std::vector<Trapezoid>& trapezoids() const { return trapezoids_; }

 private:
  enum class Kind : std::uint8_t { kTrapezoid, kLeftEnd, kRightEnd, kSegment };
  /// A comparison with a segment's end or with a segment. The first child applies if the point is left of the
  /// end or below the segment; otherwise the second applies.
  struct Node {
    Kind kind = Kind::kTrapezoid;
    Index index = kNone;  // index of the trapezoid or segment
    std::array<Index, 2> children{kNone, kNone};
  };

  Index new_trapezoid(Index bottom, Index top, const GridPoint& left, const GridPoint& right);
  Index new_node(Kind kind, Index index, const std::array<Index, 2>& children = {kNone, kNone});
  void insert(Index segment);
  /// Writes the trapezoids that a segment crosses to crossed_, from left to right.
  void find_crossed(const GridSegment& segment);
  Index locate_left_end(const GridSegment& segment) const;
  /// Divides the trapezoids in crossed_ into parts above and below a segment, and links them.
  void divide_crossed(Index segment, Index left_part, Index right_part);
  /// Replaces the leaf of a crossed trapezoid with comparisons.
  void replace_leaf(std::size_t i, Index segment, Index left_part, Index right_part);
  /// Makes the neighbour of a removed trapezoid a neighbour of a new trapezoid; `neighbour` may be kNone.
  void adopt_left_neighbour(Index trapezoid, std::size_t which, Index neighbour, Index removed);
  void adopt_right_neighbour(Index trapezoid, std::size_t which, Index neighbour, Index removed);
  void link(Index left, Index right, std::size_t which);

  std::vector<GridSegment> segments_;
  std::vector<Trapezoid> trapezoids_;
  std::vector<Node> nodes_;  // the first is the root
  std::vector<Index> order_, free_trapezoids_;
  std::vector<Index> crossed_, upper_, lower_;  // trapezoids of the segment that is being inserted
};

}  // namespace sidestep
