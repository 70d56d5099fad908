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

/// Heights over a grid, row by row: the first in the corner with the smallest x and y, then along x.
struct HeightField {
  Vec2 corner_m{0, 0};
  double spacing_m = 1;
  std::size_t columns = 0, rows = 0;
  std::vector<double> heights_m;
};

/// Ground of triangles, none of which lies over another, in a K-D tree with a box for each node (Bruce 2006,
/// chapter 3). Distances are searched for in near boxes first, and not at all in boxes that are too far.
class TerrainTree {
 public:
  using Corners = std::array<std::uint32_t, 3>;

  /// Two triangles to each square of the grid. Throws std::invalid_argument where there is no square, the
  /// number of heights is wrong, or something is not finite.
  explicit TerrainTree(const HeightField& field);
  /// Throws std::invalid_argument where there are no triangles, or corners that do not exist or are not
  /// finite.
  TerrainTree(std::vector<Vec3> points_m, std::vector<Corners> triangles);

  /// To the nearest point of the ground. Places that are not finite are refused with std::invalid_argument,
  /// as they are in all that follows.
  double distance_m(const Vec3& at_m) const { return distance_m(at_m, at_m); }
  /// The smallest between points of the segment and of the ground.
  double distance_m(const Vec3& from_m, const Vec3& to_m) const;
  /// The smallest height of a point of the segment over the ground, negative below, infinite where there is
  /// no ground.
  double height_m(const Vec3& from_m, const Vec3& to_m) const;
  /// Whether a ball comes to the ground on its way, or is below it.
  bool touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const;

 private:
  struct Node {
    Vec3 min_m, max_m;
    std::uint32_t first = 0, count = 0;  // triangles
    std::uint32_t second_child = 0;      // the first one is next; 0: a leaf
  };
  struct Line;

  void build(std::uint32_t first, std::uint32_t count, std::vector<Vec3>& middles,
             std::vector<std::uint32_t>& order);
  Triangle triangle(std::uint32_t at) const;
  static double height_over(const Line& line, const Triangle& triangle);
  void find_nearest(std::uint32_t node, const Line& line, double enough2_m2, double& nearest2_m2) const;
  void find_lowest(std::uint32_t node, const Line& line, double& lowest_m) const;

  std::vector<Vec3> points_m_;
  std::vector<Corners> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace sidestep
