// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/collision/terrain_tree.hpp"

namespace sidestep {

/// A straight motion of a ball.
struct Flight {
  Vec3 from_m, to_m;
};

/// Hills on a square kilometre, in `squares` by `squares` grid squares of two triangles each, and short
/// flights of a ball that begin above them.
struct TerrainProblem {
  TerrainProblem(std::size_t squares, std::size_t flights, std::uint64_t seed);

  static constexpr double kRadius_m = 5;

  std::vector<Vec3> points_m{};
  std::vector<TerrainTree::Corners> triangles{};
  std::vector<Flight> flights{};
};

/// The reference, which compares every query with all triangles.
class LinearTerrain {
 public:
  explicit LinearTerrain(const TerrainProblem& problem);
  [[nodiscard]] bool touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const;
  [[nodiscard]] double clearance_m(const Vec3& from_m, const Vec3& to_m, double radius_m) const;

 private:
  std::vector<Triangle> triangles_;
};

}  // namespace sidestep
