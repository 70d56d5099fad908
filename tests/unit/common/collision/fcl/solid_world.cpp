// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/common/collision/fcl/solid_world.hpp"

#include <algorithm>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace sidestep {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool find_distance(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* nearest, double& bound) {
  fcl::DistanceResultd result;
  double& nearest_m = *static_cast<double*>(nearest);
  // With FCL's default solver and tolerance, one distance in forty is too large, by up to centimetres.
  const fcl::DistanceRequestd request(false, false, 0, 0, 1e-9, fcl::GST_INDEP);
  fcl::distance(a, b, request, result);
  // For overlapping shapes, FCL returns -1 or another negative number.
  nearest_m = std::min(nearest_m, std::max(0.0, result.min_distance));
  bound = nearest_m;
  return nearest_m == 0;
}

}  // namespace

Solid mesh(std::span<const Eigen::Vector3d> corners, std::span<const std::array<std::size_t, 3>> triangles) {
  if (triangles.empty()) throw std::invalid_argument("a mesh has no triangles");
  std::vector<fcl::Triangle> faces;
  for (const auto& [a, b, c] : triangles) {
    if (std::max({a, b, c}) >= corners.size())
      throw std::invalid_argument("a mesh triangle refers to a corner that does not exist");
    faces.emplace_back(a, b, c);
  }
  for (const Eigen::Vector3d& corner : corners)
    if (!corner.allFinite()) throw std::invalid_argument("a mesh's corner is not finite");
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel(static_cast<int>(faces.size()), static_cast<int>(corners.size()));
  model->addSubModel({corners.begin(), corners.end()}, faces);
  model->endModel();
  return model;
}

SolidWorld::Id SolidWorld::add(Solid solid, const Eigen::Isometry3d& pose) {
  auto object = std::make_unique<fcl::CollisionObjectd>(std::move(solid), pose);
  object->computeAABB();
  manager_.registerObject(object.get());
  manager_.setup();
  objects_.emplace(next_, std::move(object));
  return next_++;
}

void SolidWorld::move(Id id, const Eigen::Isometry3d& pose) {
  fcl::CollisionObjectd& moved = object(id);
  moved.setTransform(pose);
  moved.computeAABB();
  manager_.update(&moved);
}

void SolidWorld::remove(Id id) {
  manager_.unregisterObject(&object(id));
  objects_.erase(id);
}

double SolidWorld::clearance_m(const Solid& body, const Eigen::Isometry3d& pose) const {
  fcl::CollisionObjectd query(body, pose);
  query.computeAABB();
  double nearest_m = kInfinite;
  manager_.distance(&query, &nearest_m, find_distance);
  return nearest_m;
}

fcl::CollisionObjectd& SolidWorld::object(Id id) {
  const auto found = objects_.find(id);
  if (found == objects_.end()) throw std::invalid_argument("there is no solid " + std::to_string(id));
  return *found->second;
}

}  // namespace sidestep
