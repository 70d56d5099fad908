// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/collision/shapes.hpp"
#include "common/geometry/box.hpp"

namespace sidestep {

/// Where a picture shows a part of a floor.
struct FloorView {
  Box part_m;
  double pixels_per_metre = 100;
  Vec2 corner_px{0, 0};  ///< the upper left corner of the part

  Vec2 px(const Vec2& p_m) const {
    return corner_px + pixels_per_metre * Vec2(p_m.x() - part_m.min_m.x(), part_m.max_m.y() - p_m.y());
  }
  std::vector<Vec2> px(std::span<const Vec2> points_m) const;
  double px(double length_m) const { return pixels_per_metre * length_m; }
  Vec2 size_px() const { return pixels_per_metre * (part_m.max_m - part_m.min_m); }
};

[[nodiscard]] std::string svg_disc(const FloorView& view, const Vec2& centre_m, double radius_m,
                                   std::string_view attributes);
[[nodiscard]] std::string svg_polyline(const FloorView& view, std::span<const Vec2> points_m,
                                       std::string_view attributes);
[[nodiscard]] std::string svg_polygon(const FloorView& view, std::span<const Vec2> corners_m,
                                      std::string_view attributes);
/// Segments as one path.
[[nodiscard]] std::string svg_segments(const FloorView& view, std::span<const Segment> segments,
                                       std::string_view attributes);
/// Draws a static obstacle.
[[nodiscard]] std::string svg_obstacle(const FloorView& view, const Shape& shape);
/// Draws static obstacles, for example the walls of a map, as one path; empty if there are none.
[[nodiscard]] std::string svg_obstacles(const FloorView& view, std::span<const Box> boxes);

inline constexpr const char* kObstacleColour = "#57606a";

}  // namespace sidestep
