// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/visibility/bend.hpp"

namespace sidestep {
namespace {

/// Round a corner where an edge comes in and another goes out, counter-clockwise and both of length 1.
Bend corner_bend(const Vec2& corner, double min_separation_m, const Vec2& in_along, const Vec2& out_along) {
  return {corner, min_separation_m, true, -left_of(in_along), -left_of(out_along)};
}

void append(const Circle& circle, double min_separation_m, std::vector<Bend>& bends) {
  bends.push_back({circle.centre_m, circle.radius_m + min_separation_m});
}

void append_corners_of(const Vec2* corners, std::size_t count, double min_separation_m, std::vector<Bend>& bends) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 in = corners[i] - corners[(i + count - 1) % count],
               out = corners[(i + 1) % count] - corners[i];
    bends.push_back(corner_bend(corners[i], min_separation_m, in.normalized(), out.normalized()));
  }
}

void append(const Box& box, double min_separation_m, std::vector<Bend>& bends) {
  const Vec2 size = box.max_m - box.min_m;
  if (size.x() <= 0 || size.y() <= 0) return append_bends(Segment{box.min_m, box.max_m}, min_separation_m, bends);
  const Vec2 corners[4] = {
      box.min_m, {box.max_m.x(), box.min_m.y()}, box.max_m, {box.min_m.x(), box.max_m.y()}};
  append_corners_of(corners, 4, min_separation_m, bends);
}

void append(const ConvexPolygon& polygon, double min_separation_m, std::vector<Bend>& bends) {
  append_corners_of(polygon.corners_m.data(), polygon.corners_m.size(), min_separation_m, bends);
}

void append(const Segment& segment, double min_separation_m, std::vector<Bend>& bends) {
  const Vec2 along = segment.to_m - segment.from_m;
  if (along.squaredNorm() == 0) return append(Circle{segment.from_m, 0}, min_separation_m, bends);
  const Vec2 ends[2] = {segment.from_m, segment.to_m};
  append_corners_of(ends, 2, min_separation_m, bends);
}

}  // namespace

void append_bends(const Shape& shape, double min_separation_m, std::vector<Bend>& bends) {
  std::visit([&](const auto& s) { append(s, min_separation_m, bends); }, shape);
}

void append_corners(const Bend& bend, Side side, const Vec2& from, double turn_rad, double most_rad,
                    std::vector<Vec2>& corners) {
  constexpr double kStraight_rad = 1e-7;
  if (bend.radius_m == 0 || turn_rad < kStraight_rad) return;
  const double pieces = std::ceil(turn_rad / most_rad);
  const double piece_rad = turn_rad / pieces, out_m = bend.radius_m / std::cos(piece_rad / 2);
  const double turn = sign(side) * piece_rad;
  Vec2 direction = rotated(touching_direction(side, from), turn / 2);
  const double c = std::cos(turn), s = std::sin(turn);
  for (int i = 0; i < static_cast<int>(pieces); ++i) {
    corners.push_back(bend.centre_m + out_m * direction);
    direction = {c * direction.x() - s * direction.y(), s * direction.x() + c * direction.y()};
  }
}

}  // namespace sidestep
