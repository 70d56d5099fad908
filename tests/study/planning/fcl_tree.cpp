// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/fcl_tree.hpp"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>

#include "common/collision/fcl/prism.hpp"

namespace sidestep {
namespace {

bool touch_in_fcl(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* found) {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  const bool touches = fcl::collide(a, b, request, result) > 0;
  if (touches) *static_cast<bool*>(found) = true;
  return touches;
}

}  // namespace

struct FclTree::Tree {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
  std::shared_ptr<fcl::Capsuled> capsule = std::make_shared<fcl::Capsuled>(1, 1);
  fcl::CollisionObjectd query{capsule};
};

FclTree::FclTree(const std::vector<Shape>& shapes) : tree_(std::make_unique<Tree>()) {
  std::vector<fcl::CollisionObjectd*> objects;
  for (const Shape& shape : shapes) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Solid solid;
    if (const auto* circle = std::get_if<Circle>(&shape)) {
      solid = std::make_shared<fcl::Sphered>(circle->radius_m);
      pose.translation() << circle->centre_m, 0;
    } else {
      solid = prism(shape, 1);
    }
    tree_->objects.push_back(std::make_unique<fcl::CollisionObjectd>(solid, pose));
    objects.push_back(tree_->objects.back().get());
  }
  tree_->manager.registerObjects(objects);
  tree_->manager.setup();
}

FclTree::~FclTree() = default;

bool FclTree::touches(const Vec2& from, const Vec2& to, double radius) {
  const double length_m = (to - from).norm();
  tree_->capsule->radius = radius;
  tree_->capsule->lz = length_m;
  tree_->capsule->computeLocalAABB();
  fcl::Matrix3d turn = fcl::Matrix3d::Identity();
  if (length_m > 0) {
    const Vec2 along = (to - from) / length_m;
    turn << along.y(), 0, along.x(), -along.x(), 0, along.y(), 0, -1, 0;
  }
  const Vec2 middle = 0.5 * (from + to);
  tree_->query.setTransform(turn, fcl::Vector3d(middle.x(), middle.y(), 0));
  tree_->query.computeAABB();
  bool found = false;
  tree_->manager.collide(&tree_->query, &found, touch_in_fcl);
  return found;
}

}  // namespace sidestep
