// SPDX-License-Identifier: Apache-2.0
#include "common/collision/shapes.hpp"

#include <stdexcept>

namespace sidestep {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFarthest_m = 1e15;

void require(bool is_right, const char* what) {
  if (!is_right) throw std::invalid_argument(what);
}

void check_corners(const std::vector<Vec2>& corners) {
  double turned_rad = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2& here = corners[i];
    const Vec2 in = here - corners[(i + corners.size() - 1) % corners.size()];
    const Vec2 out = corners[(i + 1) % corners.size()] - here;
    require(in != Vec2(0, 0), "a polygon has the same corner twice in succession");
    const double turn_rad = std::atan2(cross(in, out), in.dot(out));
    require(turn_rad >= 0, "a polygon is not convex, or its corners are clockwise");
    turned_rad += turn_rad;
  }
  require(turned_rad > kPi && turned_rad < 3 * kPi, "a polygon's border does not go round once");
}

}  // namespace

void check(const Shape& shape) {
  const auto* polygon = std::get_if<ConvexPolygon>(&shape);
  require(polygon == nullptr || polygon->corners_m.size() >= 3, "a polygon has fewer than three corners");
  if (const auto* circle = std::get_if<Circle>(&shape))
    require(!(circle->radius_m < 0), "a circle's radius is negative");
  if (const auto* box = std::get_if<Box>(&shape))
    require(!(box->min_m.array() > box->max_m.array()).any(), "a box's minimum is above its maximum");
  // Of points that are no numbers, bounds may not tell.
  const auto* segment = std::get_if<Segment>(&shape);
  bool is_right = segment == nullptr || (segment->from_m.allFinite() && segment->to_m.allFinite());
  if (polygon != nullptr)
    for (const Vec2& corner : polygon->corners_m) is_right = is_right && corner.allFinite();
  require(is_right && is_near_enough(bounds(shape)),
          "a shape is not finite, or farther than 1e15 m from the origin");
  if (polygon != nullptr) check_corners(polygon->corners_m);
}

bool is_near_enough(const Box& bounds) {
  return (bounds.min_m.array() >= -kFarthest_m).all() && (bounds.max_m.array() <= kFarthest_m).all();
}

Box bounds(const Shape& shape) {
  if (const auto* circle = std::get_if<Circle>(&shape))
    return grown({circle->centre_m, circle->centre_m}, circle->radius_m);
  if (const auto* box = std::get_if<Box>(&shape)) return *box;
  if (const auto* segment = std::get_if<Segment>(&shape))
    return {segment->from_m.cwiseMin(segment->to_m), segment->from_m.cwiseMax(segment->to_m)};
  const auto& corners = std::get<ConvexPolygon>(shape).corners_m;
  Box box{corners.front(), corners.front()};
  for (const Vec2& corner : corners) box = around(box, {corner, corner});
  return box;
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
