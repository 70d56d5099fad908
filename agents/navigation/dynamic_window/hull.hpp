// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "agents/navigation/dynamic_window/arc_motion.hpp"
#include "common/geometry/convex_polygon.hpp"

namespace sidestep {

/// A polygon that contains all points within `padding_m` of `polygon`. Its edges are the edges of `polygon`
/// moved outwards, with the corners cut off. Throws std::invalid_argument if the polygon is invalid (see
/// check(Shape)) or the padding is negative or not finite.
[[nodiscard]] ConvexPolygon padded(const ConvexPolygon& polygon, double padding_m);

/// The outline of a robot in its own frame, for exact collision times, which are found by intersecting the
/// outline's edges with the arcs on which points approach the robot.
class Hull {
 public:
  /// Throws std::invalid_argument if the polygon is invalid.
  explicit Hull(const ConvexPolygon& polygon);

  /// Whether the point lies inside or on the outline.
  bool contains(const Vec2& point_m) const;
  /// The time after which a fixed point enters the moving robot's outline. 0 if it is inside or on the
  /// outline, infinite if it never enters. A point that passes a corner within a nanometre counts as
  /// entering.
  double time_to_collision_s(const Vec2& point_m, const ArcMotion& motion) const;

  std::span<const Vec2> corners_m() const { return corners_m_; }

 private:
  struct Edge {
    Vec2 from_m, along, normal;  // unit vectors; the normal points outwards
    double length_m;
  };
  std::vector<Vec2> corners_m_;
  std::vector<Edge> edges_;
};

}  // namespace sidestep
