// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <variant>
#include <vector>

#include "common/geometry/box.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/convex_polygon.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// The shape of an obstacle. All but the segment are solid.
using Shape = std::variant<Circle, Box, ConvexPolygon, Segment>;

/// Returns the circles in a list of shapes.
[[nodiscard]] std::vector<Circle> circles_of(std::span<const Shape> shapes);

/// Throws std::invalid_argument, with the reason, if a shape is invalid: numbers that are not finite or
/// beyond 1e15 m, a negative radius, a box whose minimum exceeds its maximum, corners that do not form a
/// convex polygon counter-clockwise.
void check(const Shape& shape);

/// Whether all coordinates are within ±1e15 m. False for infinities and NaN.
[[nodiscard]] bool is_in_range(const Box& bounds);

/// The bounding box of a shape.
[[nodiscard]] Box bounds(const Shape& shape);

/// The centre of the shape's bounding box.
[[nodiscard]] Vec2 centre_m(const Shape& shape);

/// The shape, translated.
[[nodiscard]] Shape moved(Shape shape, const Vec2& by_m);

/// The distance from a point to the shape's boundary, negative inside.
[[nodiscard]] double signed_distance(const Vec2& p, const Shape& shape);

/// The point on the shape's boundary nearest to a given point. If several are equally near, returns any of
/// them.
[[nodiscard]] Vec2 nearest_boundary_point(const Vec2& p, const Shape& shape);

/// A disc that stands in for the shape: at the same distance and in the same direction from `p`. For a circle
/// this is the shape itself. For other shapes it is the nearest boundary point or, if the point is inside, a
/// disc that touches this boundary point from the inside and contains `p`.
[[nodiscard]] Circle disc_facing(const Vec2& p, const Shape& shape);

/// The squared distance from a segment to the shape, 0 if they touch.
[[nodiscard]] double squared_distance(const Segment& s, const Shape& shape);

}  // namespace sidestep
