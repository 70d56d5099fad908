// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "common/geometry/box.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/convex_polygon.hpp"
#include "common/geometry/segment.hpp"

namespace sidestep {

/// What an obstacle may be. All but the segment are solid.
using Shape = std::variant<Circle, Box, ConvexPolygon, Segment>;

/// Throws std::invalid_argument that says what is wrong: numbers that are not finite, a negative radius, a
/// box whose minimum is above its maximum, corners that are not those of a convex polygon counter-clockwise.
void check(const Shape& shape);

/// Whether all is within 1e15 m of the origin; not where a number is infinite or none.
bool is_near_enough(const Box& bounds);

/// The smallest box that holds the shape.
Box bounds(const Shape& shape);

/// The shape somewhere else.
Shape moved(Shape shape, const Vec2& by_m);

/// The distance from a point to the shape's border, negative inside.
double signed_distance(const Vec2& p, const Shape& shape);

/// The square of the distance from a segment to the shape, 0 where they touch.
double squared_distance(const Segment& s, const Shape& shape);

}  // namespace sidestep
