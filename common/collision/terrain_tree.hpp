// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "common/geometry/triangle.hpp"
#include "common/geometry/vec2.hpp"

namespace sidestep {

/// Terrain heights at the points of a regular grid, row by row along x.
struct HeightField {
  Vec2 corner_m{0, 0};  ///< position of the first point, which has the smallest x and y
  double spacing_m = 1;
  std::size_t columns = 0, rows = 0;
  std::vector<double> heights_m;
};

/// Terrain made of triangles, none of which lies above another, in a K-D tree with a box per node (Bruce
/// 2006, chapter 3). Answers distance, height and contact queries, such as those of an aircraft planner. Near
/// boxes are searched first; boxes too far away are skipped.
class TerrainTree {
 public:
  using Corners = std::array<std::uint32_t, 3>;

  /// Uses two triangles per grid square. Throws std::invalid_argument if there are fewer than two columns or
  /// rows, the number of heights is wrong, the spacing is not above 0, or a height is not finite.
  explicit TerrainTree(const HeightField& field);
  /// Throws std::invalid_argument if there are no triangles, or a corner does not exist or is not finite.
  TerrainTree(std::vector<Vec3> points_m, std::vector<Corners> triangles);

  /// The distance from a point to the terrain. This and the following queries throw std::invalid_argument if
  /// a number is not finite.
  [[nodiscard]] double distance_m(const Vec3& at_m) const { return distance_m(at_m, at_m); }
  /// The distance between a segment and the terrain.
  [[nodiscard]] double distance_m(const Vec3& from_m, const Vec3& to_m) const;
  /// The minimum height of a segment above the terrain: negative below it, infinite if there is no terrain
  /// below or above the segment.
  [[nodiscard]] double min_height_m(const Vec3& from_m, const Vec3& to_m) const;
  /// Whether a ball that moves along a segment touches the terrain, or starts below it.
  [[nodiscard]] bool touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const;

 private:
  struct Node {
    Vec3 min_m, max_m;
    std::uint32_t first = 0, count = 0;  // range of the node's triangles
    std::uint32_t second_child = 0;      // the first child is the next node; 0: a leaf
  };
  struct QuerySegment;

  void build(std::uint32_t first, std::uint32_t count, std::vector<Vec3>& centroids,
             std::vector<std::uint32_t>& order);
  Triangle triangle(std::uint32_t at) const;
  static double height_above(const QuerySegment& segment, const Triangle& triangle);
  void find_nearest(std::uint32_t node, const QuerySegment& segment, double sufficient2_m2,
                    double& nearest2_m2) const;
  void find_min_height(std::uint32_t node, const QuerySegment& segment, double& min_height_m) const;

  std::vector<Vec3> points_m_;
  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace sidestep
