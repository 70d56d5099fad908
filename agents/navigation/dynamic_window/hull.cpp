// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/dynamic_window/hull.hpp"

#include <stdexcept>

#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {

ConvexPolygon padded(const ConvexPolygon& polygon, double padding_m) {
  check(polygon);
  if (!(padding_m >= 0) || !std::isfinite(padding_m))
    throw std::invalid_argument("a hull's padding has to be finite and not negative");
  if (padding_m == 0) return polygon;
  std::vector<TangentArc> arcs;
  append_arcs(polygon, padding_m, arcs);
  ConvexPolygon result;
  for (const TangentArc& arc : arcs) {
    // The direction of the edge that ends at the corner, and the turn to the edge that starts there.
    const Vec2 along = left_of(arc.first);
    append_vertices(arc, Side::kLeft, along, turn_rad(Side::kLeft, arc.first, arc.last),
                    std::numbers::pi / 2 + 1e-6, result.corners_m);
  }
  return result;
}

Hull::Hull(const ConvexPolygon& polygon) : corners_m_(polygon.corners_m) {
  check(polygon);
  for (std::size_t i = 0; i < corners_m_.size(); ++i) {
    const Vec2& from = corners_m_[i];
    const Vec2 edge = corners_m_[(i + 1) % corners_m_.size()] - from;
    const double length = edge.norm();
    if (length == 0) continue;
    const Vec2 along = edge / length;
    edges_.push_back({from, along, -left_of(along), length});
  }
}

bool Hull::contains(const Vec2& point_m) const {
  for (const Edge& edge : edges_) {
    if (edge.normal.dot(point_m - edge.from_m) > 0) return false;
  }
  return true;
}

double Hull::time_to_collision_s(const Vec2& point_m, const ArcMotion& motion) const {
  constexpr double kCorner_m = 1e-9;
  if (contains(point_m)) return 0;
  double first_s = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) {
    const double offset_m = edge.normal.dot(point_m - edge.from_m);
    const Crossing crossing = first_crossing(point_m, offset_m, edge.normal, motion);
    if (crossing.time_s >= first_s) continue;
    const double along_m = edge.along.dot(crossing.at_m - edge.from_m);
    if (along_m >= -kCorner_m && along_m <= edge.length_m + kCorner_m) first_s = crossing.time_s;
  }
  return first_s;
}

}  // namespace sidestep
