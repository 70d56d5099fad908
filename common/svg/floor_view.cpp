// SPDX-License-Identifier: Apache-2.0
#include "common/svg/floor_view.hpp"

#include <fmt/format.h>

#include "common/svg/svg.hpp"

namespace sidestep {

std::vector<Vec2> FloorView::px(std::span<const Vec2> points_m) const {
  std::vector<Vec2> points_px;
  points_px.reserve(points_m.size());
  for (const Vec2& p_m : points_m) points_px.push_back(px(p_m));
  return points_px;
}

std::string svg_disc(const FloorView& view, const Vec2& centre_m, double radius_m,
                     std::string_view attributes) {
  return svg_circle(view.px(centre_m), view.px(radius_m), attributes);
}

std::string svg_polyline(const FloorView& view, std::span<const Vec2> points_m, std::string_view attributes) {
  return fmt::format("<polyline points='{}' fill='none' {}/>\n", svg_points(view.px(points_m)), attributes);
}

std::string svg_polygon(const FloorView& view, std::span<const Vec2> corners_m, std::string_view attributes) {
  return fmt::format("<polygon points='{}' {}/>\n", svg_points(view.px(corners_m)), attributes);
}

std::string svg_segments(const FloorView& view, std::span<const Segment> segments,
                         std::string_view attributes) {
  if (segments.empty()) return {};
  std::string data;
  for (const Segment& segment : segments)
    data += svg_path_data(std::array{view.px(segment.from_m), view.px(segment.to_m)});
  return fmt::format("<path d='{}' fill='none' {}/>\n", data, attributes);
}

std::string svg_obstacle(const FloorView& view, const Shape& shape) {
  const std::string fill = fmt::format("fill='{}'", kObstacleColour);
  if (const auto* circle = std::get_if<Circle>(&shape))
    return svg_disc(view, circle->centre_m, circle->radius_m, fill);
  if (const auto* segment = std::get_if<Segment>(&shape)) {
    return svg_polyline(view, std::array{segment->from_m, segment->to_m},
                        fmt::format("stroke='{}' stroke-width='4'", kObstacleColour));
  }
  if (const auto* box = std::get_if<Box>(&shape)) return svg_polygon(view, corners_of(*box), fill);
  return svg_polygon(view, std::get<ConvexPolygon>(shape).corners_m, fill);
}

std::string svg_obstacles(const FloorView& view, std::span<const Box> boxes) {
  if (boxes.empty()) return {};
  std::string data;
  for (const Box& box : boxes) {
    const Vec2 corner = view.px(Vec2(box.min_m.x(), box.max_m.y())),
               size = view.pixels_per_metre * (box.max_m - box.min_m);
    data += fmt::format("M{:.1f} {:.1f}h{:.1f}v{:.1f}h-{:.1f}z", corner.x(), corner.y(), size.x(), size.y(),
                        size.x());
  }
  // The stroke keeps thin walls visible in large buildings.
  return fmt::format("<path d='{0}' fill='{1}' stroke='{1}' stroke-width='0.8'/>\n", data, kObstacleColour);
}

}  // namespace sidestep
