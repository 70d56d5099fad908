// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep::peers {

/// Circles compared in a plain loop over arrays, vectorised by the compiler for the build machine.
class PlainArray {
 public:
  explicit PlainArray(const std::vector<Shape>& circles);
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

 private:
  std::vector<double> x_m_, y_m_, radius_m_;
};

/// Boost's R-tree over the shapes' bounding boxes, bulk loaded, with exact comparisons of the candidates.
class BoostRTree {
 public:
  explicit BoostRTree(const std::vector<Shape>& shapes);
  ~BoostRTree();
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace sidestep::peers
