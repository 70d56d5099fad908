// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/rounded_shape.hpp"

#include <algorithm>
#include <limits>

namespace sidestep {
namespace {

double cross_of(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

RoundedShape rounded_of(const Circle& circle) { return {{circle.centre_m}, circle.radius_m}; }
RoundedShape rounded_of(const Segment& segment) { return {{segment.from_m, segment.to_m}, 0}; }
RoundedShape rounded_of(const ConvexPolygon& polygon) { return {polygon.corners_m, 0}; }
RoundedShape rounded_of(const Box& box) {
  return {{box.min_m, {box.max_m.x(), box.min_m.y()}, box.max_m, {box.min_m.x(), box.max_m.y()}}, 0};
}

/// An edge; a point is an edge without length, a segment has one edge.
struct Edge {
  Vec2 from_m, to_m;
};
std::size_t edge_count(std::span<const Vec2> corners) { return corners.size() < 3 ? 1 : corners.size(); }
Edge edge(std::span<const Vec2> corners, std::size_t i) {
  return {corners[i], corners[(i + 1) % corners.size()]};
}

Vec2 nearest_on(const Edge& edge, const Vec2& p) {
  const Vec2 along = edge.to_m - edge.from_m;
  const double length2 = along.squaredNorm();
  if (length2 == 0) return edge.from_m;
  return edge.from_m + std::clamp((p - edge.from_m).dot(along) / length2, 0.0, 1.0) * along;
}

void update_closest(ClosestPoints& best, const Vec2& a, const Vec2& b) {
  const double distance = (a - b).norm();
  if (distance < best.distance_m) best = {a, b, distance};
}

void update_closest(ClosestPoints& best, const Edge& a, const Edge& b) {
  const Vec2 along_a = a.to_m - a.from_m, along_b = b.to_m - b.from_m;
  const double b_from = cross_of(along_a, b.from_m - a.from_m), b_to = cross_of(along_a, b.to_m - a.from_m);
  const double a_from = cross_of(along_b, a.from_m - b.from_m), a_to = cross_of(along_b, a.to_m - b.from_m);
  if (b_from * b_to < 0 && a_from * a_to < 0) {
    const Vec2 common = a.from_m + a_from / (a_from - a_to) * along_a;
    best = {common, common, 0};
    return;
  }
  update_closest(best, a.from_m, nearest_on(b, a.from_m));
  update_closest(best, a.to_m, nearest_on(b, a.to_m));
  update_closest(best, nearest_on(a, b.from_m), b.from_m);
  update_closest(best, nearest_on(a, b.to_m), b.to_m);
}

bool contains(std::span<const Vec2> polygon, const Vec2& p) {
  if (polygon.size() < 3) return false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Edge side = edge(polygon, i);
    if (cross_of(side.to_m - side.from_m, p - side.from_m) < 0) return false;
  }
  return true;
}

}  // namespace

RoundedShape rounded(const Shape& shape) {
  return std::visit([](const auto& s) { return rounded_of(s); }, shape);
}

ClosestPoints closest_points(std::span<const Vec2> a, std::span<const Vec2> b) {
  if (contains(a, b[0])) return {b[0], b[0], 0};
  if (contains(b, a[0])) return {a[0], a[0], 0};
  ClosestPoints best{a[0], b[0], std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < edge_count(a); ++i)
    for (std::size_t j = 0; j < edge_count(b) && best.distance_m > 0; ++j)
      update_closest(best, edge(a, i), edge(b, j));
  return best;
}

}  // namespace sidestep
