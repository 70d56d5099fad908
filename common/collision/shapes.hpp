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

/// The circles among shapes.
[[nodiscard]] std::vector<Circle> circles_of(std::span<const Shape> shapes);

/// Throws std::invalid_argument, with the reason, if a shape is invalid: numbers that are not finite or
/// beyond 1e15 m, a negative radius, a box whose minimum exceeds its maximum, corners that do not form a
/// convex polygon counter-clockwise.
void check(const Shape& shape);

/// Whether all coordinates are within ±1e15 m; false for infinities and NaN.
[[nodiscard]] bool is_in_range(const Box& bounds);

/// The bounding box of a shape.
[[nodiscard]] Box bounds(const Shape& shape);

/// The centre of that box.
[[nodiscard]] Vec2 centre_m(const Shape& shape);

/// The shape, translated.
[[nodiscard]] Shape moved(Shape shape, const Vec2& by_m);

/// The distance from a point to the shape's boundary, negative inside.
[[nodiscard]] double signed_distance(const Vec2& p, const Shape& shape);

/// The point of the shape's boundary that is nearest to a point; any of them if there are several.
[[nodiscard]] Vec2 nearest_boundary_point(const Vec2& p, const Shape& shape);

/// A disc that is as far from a point as the shape, in the same direction: the shape itself if it is a
/// circle, otherwise the nearest point of its boundary, or a disc around the inside of it if the point is
/// inside.
[[nodiscard]] Circle disc_facing(const Vec2& p, const Shape& shape);

/// The squared distance from a segment to the shape, 0 if they touch.
[[nodiscard]] double squared_distance(const Segment& s, const Shape& shape);

}  // namespace sidestep
