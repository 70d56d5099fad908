// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "agents/planning/grids/grid_segment.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The trapezoidal map of segments, with a search structure for point location (de Berg et al. 2008, chapter
/// 6). Walls extend from each end of a segment up and down to the next segments, and divide the plane into
/// trapezoids. Segments are inserted in random order, so building takes O(n log n) and locating a point
/// O(log n) steps, expected for any segments. Reuses its memory.
class TrapezoidalMap {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0xffffffffu;

  /// Bounded by two segments, and by walls through two ends of segments. It has no width if both ends have
  /// the same x: walls are infinitesimally sheared.
  struct Trapezoid {
    Index bottom = kNone, top = kNone;  ///< segments
    GridPoint left, right;              ///< the ends that cause its walls
    /// The neighbour behind each wall that has the same bottom segment, and the one that has the same top
    /// segment; kNone if there is none.
    std::array<Index, 2> left_neighbours{kNone, kNone}, right_neighbours{kNone, kNone};
    Index leaf = kNone;  ///< of the search structure; kNone for unused trapezoids
  };
  struct Location {
    Index trapezoid;
    std::size_t steps;  ///< comparisons
  };

  /// Segments must have no more in common than ends, and lie within the box from -half to half. Throws
  /// std::invalid_argument if they do not lie within, or if it notices a crossing. The random numbers
  /// determine the search structure and the order of trapezoids, not the trapezoids themselves.
  void build(std::span<const GridSegment> segments, const GridPoint& half, Rng& rng);

  /// The trapezoid at a point of the box. A point on a segment belongs to the trapezoid above it.
  Location locate(const GridPoint& point) const;

  /// The segments, then the bottom and the top of the box.
  const std::vector<GridSegment>& segments() const { return segments_; }
  Index box_bottom() const { return static_cast<Index>(segments_.size() - 2); }
  Index box_top() const { return static_cast<Index>(segments_.size() - 1); }
  /// Including unused ones.
  const std::vector<Trapezoid>& trapezoids() const { return trapezoids_; }

 private:
  enum class Kind : std::uint8_t { kTrapezoid, kLeftEnd, kRightEnd, kSegment };
  /// A comparison with an end of a segment or with a segment. Children: if the point is left of the end or
  /// below the segment, and if not.
  struct Node {
    Kind kind = Kind::kTrapezoid;
    Index index = kNone;  // of the trapezoid or segment
    std::array<Index, 2> children{kNone, kNone};
  };

  Index new_trapezoid(Index bottom, Index top, const GridPoint& left, const GridPoint& right);
  Index new_node(Kind kind, Index index, const std::array<Index, 2>& children = {kNone, kNone});
  void insert(Index segment);
  /// Writes the trapezoids that a segment crosses, from left to right, to crossed_.
  void find_crossed(const GridSegment& segment);
  Index locate_left_end(const GridSegment& segment) const;
  /// Divides the trapezoids in crossed_ into parts above and below a segment, and links them.
  void divide_crossed(Index segment, Index left_part, Index right_part);
  /// Replaces the leaf of a crossed trapezoid by comparisons.
  void replace_leaf(std::size_t i, Index segment, Index left_part, Index right_part);
  /// Makes the neighbour of a removed trapezoid that of a new one; `neighbour` may be kNone.
  void take_left(Index trapezoid, std::size_t which, Index neighbour, Index removed);
  void take_right(Index trapezoid, std::size_t which, Index neighbour, Index removed);
  void link(Index left, Index right, std::size_t which);

  std::vector<GridSegment> segments_;
  std::vector<Trapezoid> trapezoids_;
  std::vector<Node> nodes_;  // the first is the root
  std::vector<Index> order_, free_trapezoids_;
  std::vector<Index> crossed_, upper_, lower_;  // of the segment that is being inserted
};

}  // namespace sidestep
