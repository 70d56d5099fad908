// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "common/collision/shapes.hpp"

namespace sidestep {

/// An arc that a shortest path may follow. The shortest paths of a disc consist of straight tangents and of
/// arcs around circles, or around corners of other shapes, at the distance of the disc's radius.
struct TangentArc {
  Vec2 centre_m{0, 0};
  double radius_m = 0;  ///< 0 for a start or a goal
  /// For a corner, the arc runs counter-clockwise from direction `first` to `last`, which are unit vectors
  /// from the centre, and covers at most half a circle. Otherwise the arc is a full circle.
  bool is_corner = false;
  Vec2 first{0, 0}, last{0, 0};

  /// Whether the arc covers a direction from the centre, a unit vector, within `slack_rad`.
  bool contains(const Vec2& direction, double slack_rad = 0) const {
    const double min_cross = -1e-9 - slack_rad;
    return !is_corner || (cross(first, direction) >= min_cross && cross(direction, last) >= min_cross);
  }
};

/// Appends the arcs around a shape for paths that keep `clearance_m` from it.
void append_arcs(const Shape& shape, double clearance_m, std::vector<TangentArc>& arcs);

/// The side of a path on which an arc's centre lies; the path turns to that side.
enum class Side { kLeft = 1, kRight = -1 };
inline double sign(Side side) { return static_cast<double>(side); }

/// The straight motion from one arc to another arc.
struct Tangent {
  Vec2 along{1, 0};  ///< unit vector
  double length_m = 0;
};

/// Handles overlapping circles, which have no tangent unless one of them is a point. A point up to `slack_m`
/// inside the other circle counts as lying on it: then returns true and adjusts `across_m`, the difference
/// between the centres' signed distances from the tangent.
inline bool snap_to_circle(bool is_point, double distance_m, double slack_m, double& across_m) {
  if (!is_point || std::abs(across_m) - distance_m > slack_m || distance_m == 0) return false;
  across_m = std::copysign(distance_m, across_m);
  return true;
}

/// The tangent that leaves `from` on `from_side` and reaches `to` on `to_side`; nullopt if the circles
/// overlap. Does not check whether corner arcs cover the tangent points.
[[nodiscard]] inline std::optional<Tangent> tangent(const TangentArc& from, Side from_side,
                                                    const TangentArc& to, Side to_side, double slack_m) {
  const Vec2 between = to.centre_m - from.centre_m;
  const double distance2 = between.squaredNorm();
  double across = sign(to_side) * to.radius_m - sign(from_side) * from.radius_m;
  double length2 = distance2 - across * across;
  if (length2 < 0) {
    if (!snap_to_circle(from.radius_m == 0 || to.radius_m == 0, std::sqrt(distance2), slack_m, across))
      return std::nullopt;
    length2 = 0;
  }
  if (distance2 == 0) return std::nullopt;
  const double length = std::sqrt(length2);
  return Tangent{(length * between - across * left_of(between)) / distance2, length};
}

/// The point at which a line in direction `along` touches an arc on its side.
inline Vec2 tangent_point(const TangentArc& arc, Side side, const Vec2& along) {
  return arc.centre_m - sign(side) * arc.radius_m * left_of(along);
}
/// The direction from the arc's centre to the tangent point.
inline Vec2 tangent_point_direction(Side side, const Vec2& along) { return -sign(side) * left_of(along); }

/// The turn towards a side from one direction to another direction, in [0, 2 pi). A turn to the other side
/// within rounding error counts as 0.
inline double turn_rad(Side side, const Vec2& from, const Vec2& to) {
  const double across = sign(side) * cross(from, to), along = from.dot(to);
  const double angle = std::atan2(across, along);
  constexpr double kRounding_rad = 1e-9;
  if (angle >= 0) return angle;
  return angle > -kRounding_rad ? 0 : angle + 2 * std::numbers::pi;
}

/// Appends the vertices of a polyline that circumscribes an arc, from the direction of travel `from` through
/// `turn_rad`. The path turns by at most `max_turn_rad` at each vertex.
void append_vertices(const TangentArc& arc, Side side, const Vec2& from, double turn_rad, double max_turn_rad,
                     std::vector<Vec2>& vertices);

}  // namespace sidestep
