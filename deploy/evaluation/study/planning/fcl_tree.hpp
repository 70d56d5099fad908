// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// FCL's dynamic tree of boxes over spheres and prisms on a plane, asked with a capsule that lies in it: its
/// own continuous collision iterates, while this is exact and fast. What our structures are compared with.
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
