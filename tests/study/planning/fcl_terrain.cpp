// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/fcl_terrain.hpp"

#include <algorithm>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#include <vector>

namespace sidestep {

struct FclTerrain::Model {
  Solver solver = Solver::kDefault;
  fcl::BVHModel<fcl::OBBRSSd> surface;
  std::shared_ptr<fcl::Capsuled> capsule = std::make_shared<fcl::Capsuled>(1, 1);

  /// Gives the capsule the extent of a ball's motion and returns its pose. Its axis is z.
  Eigen::Isometry3d set(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
    const Vec3 along = to_m - from_m;
    capsule->radius = radius_m;
    capsule->lz = along.norm();
    capsule->computeLocalAABB();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (capsule->lz > 0)
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), along).toRotationMatrix();
    pose.translation() = 0.5 * (from_m + to_m);
    return pose;
  }
};

FclTerrain::FclTerrain(std::span<const Vec3> points, std::span<const TerrainTree::Corners> triangles,
                       Solver solver)
    : model_(std::make_unique<Model>()) {
  model_->solver = solver;
  std::vector<fcl::Triangle> faces;
  for (const auto& [a, b, c] : triangles) faces.emplace_back(a, b, c);
  model_->surface.beginModel(static_cast<int>(faces.size()), static_cast<int>(points.size()));
  model_->surface.addSubModel({points.begin(), points.end()}, faces);
  model_->surface.endModel();
}

FclTerrain::~FclTerrain() = default;

bool FclTerrain::touches(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
  const Eigen::Isometry3d pose = model_->set(from_m, to_m, radius_m);
  fcl::CollisionRequestd request;
  if (model_->solver == Solver::kExact) request.gjk_solver_type = fcl::GST_INDEP;
  fcl::CollisionResultd result;
  return fcl::collide(&model_->surface, Eigen::Isometry3d::Identity(), model_->capsule.get(), pose, request,
                      result) > 0;
}

double FclTerrain::clearance_m(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
  const Eigen::Isometry3d pose = model_->set(from_m, to_m, radius_m);
  fcl::DistanceRequestd request;
  if (model_->solver == Solver::kExact) {
    request.gjk_solver_type = fcl::GST_INDEP;
    request.distance_tolerance = 1e-9;
  }
  fcl::DistanceResultd result;
  fcl::distance(&model_->surface, Eigen::Isometry3d::Identity(), model_->capsule.get(), pose, request,
                result);
  return std::max(0.0, result.min_distance);
}

}  // namespace sidestep
