// SPDX-License-Identifier: Apache-2.0
#include "common/collision/shapes.hpp"

#include <numbers>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr double kMaxCoordinate_m = 1e15;

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(what);
}

void check_corners(const std::vector<Vec2>& corners) {
  double total_turn_rad = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& here = corners[i];
    const Vec2 in = here - corners[(i + corners.size() - 1) % corners.size()];
    const Vec2 out = corners[(i + 1) % corners.size()] - here;
    require(in != Vec2(0, 0), "a polygon has two identical successive corners");
    const double turn_rad = std::atan2(cross(in, out), in.dot(out));
    require(turn_rad >= 0, "a polygon is not convex, or its corners are clockwise");
    total_turn_rad += turn_rad;
  }
  require(total_turn_rad > std::numbers::pi && total_turn_rad < 3 * std::numbers::pi,
          "a polygon's boundary must make exactly one full turn");
}

}  // namespace

std::vector<Circle> circles_of(std::span<const Shape> shapes) {
  std::vector<Circle> circles;
  for (const Shape& shape : shapes)
    if (const auto* circle = std::get_if<Circle>(&shape)) circles.push_back(*circle);
  return circles;
}

void check(const Shape& shape) {
  const auto* polygon = std::get_if<ConvexPolygon>(&shape);
  require(polygon == nullptr || polygon->corners_m.size() >= 3, "a polygon has fewer than three corners");
  if (const auto* circle = std::get_if<Circle>(&shape))
    require(!(circle->radius_m < 0), "a circle's radius is negative");
  if (const auto* box = std::get_if<Box>(&shape))
    require(!(box->min_m.array() > box->max_m.array()).any(), "a box's minimum is above its maximum");
  // The bounds of points with NaN coordinates may look valid.
  const auto* segment = std::get_if<Segment>(&shape);
  bool condition = segment == nullptr || (segment->from_m.allFinite() && segment->to_m.allFinite());
  if (polygon != nullptr)
    for (const Vec2& corner : polygon->corners_m) condition = condition && corner.allFinite();
  require(condition && is_in_range(bounds(shape)),
          "a shape is not finite, or farther than 1e15 m from the origin");
  if (polygon != nullptr) check_corners(polygon->corners_m);
}

bool is_in_range(const Box& bounds) {
  return (bounds.min_m.array() >= -kMaxCoordinate_m).all() &&
         (bounds.max_m.array() <= kMaxCoordinate_m).all();
}

Box bounds(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return inflated({circle->centre_m, circle->centre_m}, circle->radius_m);
  if (const auto* box = std::get_if<Box>(&shape)) return *box;
  if (const auto* segment = std::get_if<Segment>(&shape))
    return {segment->from_m.cwiseMin(segment->to_m), segment->from_m.cwiseMax(segment->to_m)};
  const auto& corners = std::get<ConvexPolygon>(shape).corners_m;
  Box box{corners.front(), corners.front()};
  for (const Vec2& corner : corners) box = united(box, {corner, corner});
  return box;
}

Vec2 centre_m(const Shape& shape) {
  const Box box = bounds(shape);
  return (box.min_m + box.max_m) / 2;
}

Shape moved(Shape shape, const Vec2& by) {
  if (auto* circle = std::get_if<Circle>(&shape)) {
    circle->centre_m += by;
  } else if (auto* box = std::get_if<Box>(&shape)) {
    *box = {box->min_m + by, box->max_m + by};
  } else if (auto* segment = std::get_if<Segment>(&shape)) {
    *segment = {segment->from_m + by, segment->to_m + by};
  } else {
    for (Vec2& corner : std::get<ConvexPolygon>(shape).corners_m) corner += by;
  }
  return shape;
}

double signed_distance(const Vec2& p, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return (p - circle->centre_m).norm() - circle->radius_m;
  if (const auto* box = std::get_if<Box>(&shape)) return signed_distance(p, *box);
  if (const auto* segment = std::get_if<Segment>(&shape)) return std::sqrt(squared_distance(p, *segment));
  return signed_distance(p, std::get<ConvexPolygon>(shape).corners_m);
}

Vec2 nearest_boundary_point(const Vec2& p, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const Vec2 offset = p - circle->centre_m;
    return circle->centre_m +
           circle->radius_m * (offset.isZero(0) ? Vec2(1, 0) : Vec2(offset.stableNormalized()));
  }
  if (const auto* segment = std::get_if<Segment>(&shape))
    return segment->from_m + nearest_offset(p, *segment);
  if (const auto* box = std::get_if<Box>(&shape)) return nearest_edge_point(p, corners_of(*box));
  return nearest_edge_point(p, std::get<ConvexPolygon>(shape).corners_m);
}

Circle disc_facing(const Vec2& p, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) return *circle;
  const Vec2 nearest = nearest_boundary_point(p, shape), inwards = p - nearest;
  if (signed_distance(p, shape) >= 0) return {nearest, 0};
  return {p + inwards, 2 * inwards.norm()};
}

double squared_distance(const Segment& s, const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    const double distance = std::sqrt(squared_distance(circle->centre_m, s)) - circle->radius_m;
    return distance > 0 ? distance * distance : 0;
  }
  if (const auto* box = std::get_if<Box>(&shape)) return squared_distance(s, corners_of(*box));
  if (const auto* segment = std::get_if<Segment>(&shape)) return squared_distance(s, *segment);
  return squared_distance(s, std::get<ConvexPolygon>(shape).corners_m);
}

}  // namespace sidestep
