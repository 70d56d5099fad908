// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>
#include <memory>
#include <utility>
#include <vector>

#include "common/geometry/box.hpp"
#include "common/geometry/circle.hpp"

namespace sidestep::peers {

/// A disc on its way, prepared for many comparisons.
struct Sweep {
  Sweep(const Vec2& from, const Vec2& to, double radius)
      : from_m(from),
        way_m(to - from),
        radius_m(radius),
        per_length2(1 / std::max(way_m.squaredNorm(), 1e-300)) {}

  bool touches(double x_m, double y_m, double disc_radius_m) const {
    const double dx = x_m - from_m.x(), dy = y_m - from_m.y();
    const double foot = (dx * way_m.x() + dy * way_m.y()) * per_length2;
    const double along = std::min(std::max(foot, 0.0), 1.0);
    const double ex = dx - along * way_m.x(), ey = dy - along * way_m.y(), reach = radius_m + disc_radius_m;
    return ex * ex + ey * ey <= reach * reach;
  }

  Vec2 from_m, way_m;
  double radius_m, per_length2;
};

/// Squared distances in a plain loop over arrays, which the compiler makes vectors of, for this machine's.
class PlainArray {
 public:
  explicit PlainArray(const std::vector<Circle>& circles);
  bool touches(const Sweep& sweep) const;

 private:
  std::vector<double> x_m_, y_m_, radius_m_;
};

/// Boost's R-tree over the circles' boxes, bulk loaded; circles in it are compared exactly.
class BoostRTree {
 public:
  explicit BoostRTree(const std::vector<Circle>& circles);
  bool touches(const Sweep& sweep) const;

 private:
  using Point = boost::geometry::model::d2::point_xy<double>;
  using Bounds = boost::geometry::model::box<Point>;
  using Entry = std::pair<Bounds, Circle>;

  boost::geometry::index::rtree<Entry, boost::geometry::index::rstar<16>> tree_;
};

/// FCL's dynamic tree of boxes over spheres on a plane, asked with a capsule that lies in it: its own
/// continuous collision iterates, while this is exact and fast.
class FclTree {
 public:
  explicit FclTree(const std::vector<Circle>& circles);
  bool touches(const Sweep& sweep);

 private:
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
  std::shared_ptr<fcl::Capsuled> capsule_;
  fcl::CollisionObjectd query_;
};

}  // namespace sidestep::peers
