// SPDX-License-Identifier: Apache-2.0
// The peers, compiled for the instruction set of the build machine.
#include "tests/bench/collision_peers.hpp"

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>

namespace sidestep::peers {
namespace {

constexpr std::size_t kBatchSize = 64;  // circles compared before the loop checks for a hit

/// A moving disc, prepared for many comparisons.
struct SweptDisc {
  SweptDisc(const Vec2& from, const Vec2& to, double own_radius)
      : from_x(from.x()), from_y(from.y()), x(to.x() - from.x()), y(to.y() - from.y()), radius(own_radius) {
    per_length2 = 1 / std::max(x * x + y * y, 1e-300);
  }
  bool touches(double at_x, double at_y, double disc_radius) const {
    const double dx = at_x - from_x, dy = at_y - from_y;
    const double foot = (dx * x + dy * y) * per_length2, along = std::min(std::max(foot, 0.0), 1.0);
    const double ex = dx - along * x, ey = dy - along * y, reach = radius + disc_radius;
    return ex * ex + ey * ey <= reach * reach;
  }
  double from_x, from_y, x, y, radius, per_length2;
};

using Point = boost::geometry::model::d2::point_xy<double>;
using Bounds = boost::geometry::model::box<Point>;
using Entry = std::pair<Bounds, const Shape*>;

Bounds bounds_in_boost(const Box& box) {
  return {{box.min_m.x(), box.min_m.y()}, {box.max_m.x(), box.max_m.y()}};
}

}  // namespace

PlainArray::PlainArray(const std::vector<Shape>& circles) {
  for (const Shape& shape : circles) {
    const auto& circle = std::get<Circle>(shape);
    x_m_.push_back(circle.centre_m.x());
    y_m_.push_back(circle.centre_m.y());
    radius_m_.push_back(circle.radius_m);
  }
}

bool PlainArray::touches(const Vec2& from, const Vec2& to, double radius) const {
  const SweptDisc disc(from, to, radius);
  const double *x = x_m_.data(), *y = y_m_.data(), *radii = radius_m_.data();
  for (std::size_t begin = 0; begin < x_m_.size(); begin += kBatchSize) {
    const std::size_t end = std::min(begin + kBatchSize, x_m_.size());
    std::int64_t touched = 0;
    for (std::size_t i = begin; i < end; ++i) touched |= disc.touches(x[i], y[i], radii[i]);
    if (touched != 0) return true;
  }
  return false;
}

struct BoostRTree::Tree {
  std::vector<Shape> shapes;
  boost::geometry::index::rtree<Entry, boost::geometry::index::rstar<16>> boxes;
};

BoostRTree::BoostRTree(const std::vector<Shape>& shapes) : tree_(std::make_unique<Tree>()) {
  tree_->shapes = shapes;
  std::vector<Entry> entries;
  for (const Shape& shape : tree_->shapes) entries.emplace_back(bounds_in_boost(bounds(shape)), &shape);
  tree_->boxes = {entries.begin(), entries.end()};
}

BoostRTree::~BoostRTree() = default;

bool BoostRTree::touches(const Vec2& from, const Vec2& to, double radius) const {
  namespace index = boost::geometry::index;
  const SweptDisc disc(from, to, radius);
  const Bounds query = bounds_in_boost(inflated({from.cwiseMin(to), from.cwiseMax(to)}, radius));
  const auto touched = [&](const Entry& entry) {
    if (const auto* circle = std::get_if<Circle>(entry.second))
      return disc.touches(circle->centre_m.x(), circle->centre_m.y(), circle->radius_m);
    return squared_distance(Segment{from, to}, *entry.second) <= radius * radius;
  };
  return tree_->boxes.qbegin(index::intersects(query) && index::satisfies(touched)) != tree_->boxes.qend();
}

}  // namespace sidestep::peers
