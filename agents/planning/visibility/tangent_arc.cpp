// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {
namespace {

/// The arc around a corner; `in_along` and `out_along` are the unit directions of the incoming and the
/// outgoing edge, counter-clockwise.
TangentArc corner_arc(const Vec2& corner, double clearance_m, const Vec2& in_along, const Vec2& out_along) {
  return {corner, clearance_m, true, -left_of(in_along), -left_of(out_along)};
}

void append(const Circle& circle, double clearance_m, std::vector<TangentArc>& arcs) {
  arcs.push_back({circle.centre_m, circle.radius_m + clearance_m});
}

void append_corner_arcs(const Vec2* vertices, std::size_t count, double clearance_m,
                        std::vector<TangentArc>& arcs) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 in = vertices[i] - vertices[(i + count - 1) % count],
               out = vertices[(i + 1) % count] - vertices[i];
    arcs.push_back(corner_arc(vertices[i], clearance_m, in.normalized(), out.normalized()));
  }
}

void append(const Box& box, double clearance_m, std::vector<TangentArc>& arcs) {
  const Vec2 size = box.max_m - box.min_m;
  if (size.x() <= 0 || size.y() <= 0) return append_arcs(Segment{box.min_m, box.max_m}, clearance_m, arcs);
  const Vec2 vertices[4] = {
      box.min_m, {box.max_m.x(), box.min_m.y()}, box.max_m, {box.min_m.x(), box.max_m.y()}};
  append_corner_arcs(vertices, 4, clearance_m, arcs);
}

void append(const ConvexPolygon& polygon, double clearance_m, std::vector<TangentArc>& arcs) {
  append_corner_arcs(polygon.corners_m.data(), polygon.corners_m.size(), clearance_m, arcs);
}

void append(const Segment& segment, double clearance_m, std::vector<TangentArc>& arcs) {
  const Vec2 along = segment.to_m - segment.from_m;
  if (along.squaredNorm() == 0) return append(Circle{segment.from_m, 0}, clearance_m, arcs);
  const Vec2 ends[2] = {segment.from_m, segment.to_m};
  append_corner_arcs(ends, 2, clearance_m, arcs);
}

}  // namespace

void append_arcs(const Shape& shape, double clearance_m, std::vector<TangentArc>& arcs) {
  std::visit([&](const auto& s) { append(s, clearance_m, arcs); }, shape);
}

void append_vertices(const TangentArc& arc, Side side, const Vec2& from, double turn_rad, double max_turn_rad,
                     std::vector<Vec2>& vertices) {
  constexpr double kStraight_rad = 1e-7;
  if (arc.radius_m == 0 || turn_rad < kStraight_rad) return;
  const double vertex_count = std::ceil(turn_rad / max_turn_rad);
  const double vertex_rad = turn_rad / vertex_count, out_m = arc.radius_m / std::cos(vertex_rad / 2);
  const double turn = sign(side) * vertex_rad;
  Vec2 direction = rotated(tangent_point_direction(side, from), turn / 2);
  const double c = std::cos(turn), s = std::sin(turn);
  for (int i = 0; i < static_cast<int>(vertex_count); ++i) {
    vertices.push_back(arc.centre_m + out_m * direction);
    direction = {c * direction.x() - s * direction.y(), s * direction.x() + c * direction.y()};
  }
}

}  // namespace sidestep
