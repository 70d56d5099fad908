// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/plan_picture.hpp"

#include <fmt/format.h>

#include "deploy/trial/shape_picture.hpp"

namespace sidestep {
namespace {

constexpr double kPixelsPerMetre = 100;

double x_of(const Vec2& p) { return kPixelsPerMetre * p.x(); }
/// SVG's y axis points down.
double y_of(const Vec2& p) { return -kPixelsPerMetre * p.y(); }

std::string line(const Segment& s) {
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x_of(s.from_m), y_of(s.from_m), x_of(s.to_m),
                     y_of(s.to_m));
}

std::string lines(const std::vector<Segment>& segments, const char* colour) {
  if (segments.empty()) return {};
  std::string path;
  for (const Segment& segment : segments) path += line(segment);
  return fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='1'/>\n", path, colour);
}

std::string disc(const Vec2& centre, double radius_m, const char* style) {
  return svg_disc(centre, radius_m, style, kPixelsPerMetre);
}

std::string polyline(const std::vector<Vec2>& path, const char* style) {
  return fmt::format("<polyline points='{}' fill='none' {}/>\n", svg_points(path, kPixelsPerMetre), style);
}

}  // namespace

std::string plan_picture(const PlanWorld& world, const PlanQuery& query, const PlanDrawing& drawing,
                         const std::vector<Vec2>& path_m, const std::vector<Vec2>& smoothed_m) {
  const double width = kPixelsPerMetre * world.field.length_m, height = kPixelsPerMetre * world.field.width_m;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='{:.1f} {:.1f} {:.1f} {:.1f}'>\n<rect x='{:.1f}' "
      "y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f6f8fa' stroke='#8b949e' stroke-width='2'/>\n",
      -width / 2, -height / 2, width, height, -width / 2, -height / 2, width, height);
  for (const ConvexPolygon& cell : drawing.cells)
    svg += fmt::format("<polygon points='{}' fill='#dafbe1' stroke='#2da44e' stroke-width='0.5'/>\n",
                       svg_points(cell.corners_m, kPixelsPerMetre));
  for (const Shape& shape : world.obstacles) svg += svg_obstacle(shape, kPixelsPerMetre);
  svg += lines(drawing.tree, "#1f6feb") + lines(drawing.goal_tree, "#bf8700");
  for (const Vec2& point : drawing.cache) svg += disc(point, 0.03, "fill='#8250df'");
  for (const Circle& bubble : drawing.band)
    svg += disc(bubble.centre_m, bubble.radius_m, "fill='#bf8700' fill-opacity='0.15' stroke='#bf8700'");
  svg += polyline(path_m, "stroke='#8b949e' stroke-width='3' stroke-dasharray='6 4'");
  svg += polyline(smoothed_m, "stroke='#cf222e' stroke-width='4'");
  svg += disc(query.start_m, world.radius_m, "fill='#2da44e'");
  svg += disc(query.goal_m, world.radius_m, "fill='none' stroke='#cf222e' stroke-width='3'");
  return svg + "</svg>\n";
}

}  // namespace sidestep
