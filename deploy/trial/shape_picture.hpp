// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <fmt/format.h>
#include <span>
#include <string>

#include "common/collision/shapes.hpp"

namespace sidestep {

// Parts of SVG pictures, whose y axis points down.

/// The points of a polyline or polygon, as "x,y x,y ".
inline std::string svg_points(std::span<const Vec2> points_m, double pixels_per_metre) {
  std::string text;
  for (const Vec2& p : points_m)
    text += fmt::format("{:.1f},{:.1f} ", pixels_per_metre * p.x(), -pixels_per_metre * p.y());
  return text;
}

inline std::string svg_disc(const Vec2& centre_m, double radius_m, const std::string& style,
                            double pixels_per_metre) {
  return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}' {}/>\n", pixels_per_metre * centre_m.x(),
                     -pixels_per_metre * centre_m.y(), pixels_per_metre * radius_m, style);
}

/// Draws a static obstacle.
inline std::string svg_obstacle(const Shape& shape, double pixels_per_metre) {
  constexpr const char* kColour = "#57606a";
  if (const auto* circle = std::get_if<Circle>(&shape))
    return svg_disc(circle->centre_m, circle->radius_m, fmt::format("fill='{}'", kColour), pixels_per_metre);
  if (const auto* segment = std::get_if<Segment>(&shape)) {
    return fmt::format("<polyline points='{}' stroke='{}' stroke-width='4'/>\n",
                       svg_points(std::array{segment->from_m, segment->to_m}, pixels_per_metre), kColour);
  }
  const auto polygon = [&](std::span<const Vec2> corners) {
    return fmt::format("<polygon points='{}' fill='{}'/>\n", svg_points(corners, pixels_per_metre), kColour);
  };
  if (const auto* box = std::get_if<Box>(&shape)) return polygon(corners_of(*box));
  return polygon(std::get<ConvexPolygon>(shape).corners_m);
}

}  // namespace sidestep
