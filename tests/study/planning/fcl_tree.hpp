// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// FCL's dynamic tree of boxes over spheres and prisms on a plane, queried with a capsule in that plane. It
/// is the counterpart of our structures. The capsule is exact and fast, whereas FCL's continuous collision
/// detection iterates.
class FclTree {
 public:
  explicit FclTree(const std::vector<Shape>& shapes);
  ~FclTree();
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m);

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sidestep
