// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>

#include "common/collision/terrain_tree.hpp"

namespace sidestep {

/// FCL's tree of boxes over a mesh (oriented boxes and spheres), queried with a capsule. It is the
/// counterpart of TerrainTree. FCL knows only the surface, so a motion must start above it.
class FclTerrain {
 public:
  enum class Solver {
    kDefault,  ///< FCL's own choice and tolerance
    kExact,    ///< FCL's other solver (GST_INDEP), with a tolerance of 1e-9 for distances
  };

  FclTerrain(std::span<const Vec3> points_m, std::span<const TerrainTree::Corners> triangles, Solver solver);
  ~FclTerrain();

  /// Whether a ball that moves along a segment touches the surface.
  [[nodiscard]] bool touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const;
  /// The smallest distance of the ball from the surface, 0 where it touches.
  [[nodiscard]] double clearance_m(const Vec3& from_m, const Vec3& to_m, double radius_m) const;

 private:
  struct Model;
  std::unique_ptr<Model> model_;
};

}  // namespace sidestep
