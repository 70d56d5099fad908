// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <map>
#include <memory>
#include <span>

#include "common/collision/shapes.hpp"
#include "common/collision/sweep_by_distance.hpp"

namespace sidestep {

/// Any shape of FCL. Meshes are surfaces: what is inside of one without touching it is clear of it.
using Solid = std::shared_ptr<fcl::CollisionGeometryd>;

/// A surface of triangles, each by its corners' places in `corners_m`. Throws std::invalid_argument where
/// there are none, a corner does not exist or is not finite.
Solid mesh(std::span<const Eigen::Vector3d> corners_m, std::span<const std::array<std::size_t, 3>> triangles);

/// A shape of the floor with so much height, half of it below the floor; where its own origin is the floor's.
/// Throws std::invalid_argument where the shape is none or the height not above 0.
Solid prism(const Shape& shape, double height_m);

/// Obstacles of three dimensions, of which FCL knows the distances.
class SolidWorld {
 public:
  using Id = std::uint32_t;

  SolidWorld() = default;
  SolidWorld(const SolidWorld&) = delete;
  SolidWorld& operator=(const SolidWorld&) = delete;

  Id add(Solid solid, const Eigen::Isometry3d& place);
  /// Throws std::invalid_argument, as remove does, where there is no such obstacle.
  void move(Id id, const Eigen::Isometry3d& place);
  void remove(Id id);

  /// The distance of a body at a place from the nearest obstacle: 0 where it touches, infinite where there is
  /// none.
  double clearance_m(const Solid& body, const Eigen::Isometry3d& place) const;

  /// What a body's ways are asked that does not turn; the world has to outlive it.
  auto sweep(const Solid& body, const Eigen::Isometry3d& from, const Eigen::Vector3d& to_m,
             double margin_m = 0) const {
    const auto clearance = [this, body, from](const Eigen::Vector3d& at_m) {
      Eigen::Isometry3d place = from;
      place.translation() = at_m;
      return clearance_m(body, place);
    };
    return SweepByDistance(Eigen::Vector3d(from.translation()), to_m, margin_m, clearance);
  }

 private:
  fcl::CollisionObjectd& object(Id id);

  std::map<Id, std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  Id next_ = 0;
};

}  // namespace sidestep
