// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <map>
#include <memory>
#include <span>

#include "common/collision/fcl/prism.hpp"
#include "common/collision/sweep_by_distance.hpp"

namespace sidestep {

/// A triangle mesh, given by indices into `corners_m`. The inside of a closed mesh is free space. Throws
/// std::invalid_argument if there are no triangles, or if a corner does not exist or is not finite.
[[nodiscard]] Solid mesh(std::span<const Eigen::Vector3d> corners_m,
                         std::span<const std::array<std::size_t, 3>> triangles);

/// Three-dimensional obstacles with distances computed by FCL: the independent reference for ObstacleWorld
/// and TerrainTree, and a distance source for SweepByDistance.
class SolidWorld {
 public:
  using Id = std::uint32_t;

  SolidWorld() = default;
  SolidWorld(const SolidWorld&) = delete;
  SolidWorld& operator=(const SolidWorld&) = delete;

  Id add(Solid solid, const Eigen::Isometry3d& pose);
  /// Throws std::invalid_argument if there is no such obstacle, like remove().
  void move(Id id, const Eigen::Isometry3d& pose);
  void remove(Id id);

  /// The distance between a body at a pose and the nearest obstacle; 0 in contact, infinite without
  /// obstacles.
  [[nodiscard]] double clearance_m(const Solid& body, const Eigen::Isometry3d& pose) const;

  /// Swept queries for a body that translates without rotating. The world must outlive the returned object.
  auto sweep(const Solid& body, const Eigen::Isometry3d& from, const Eigen::Vector3d& to_m,
             double margin_m = 0) const {
    const auto clearance = [this, body, from](const Eigen::Vector3d& at_m) {
      Eigen::Isometry3d pose = from;
      pose.translation() = at_m;
      return clearance_m(body, pose);
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
