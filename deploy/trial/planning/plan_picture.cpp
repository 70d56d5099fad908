// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/planning/plan_picture.hpp"

#include <fmt/format.h>

#include "common/svg/floor_sheet.hpp"

namespace sidestep {
namespace {

constexpr const char *kTree = "#1f6feb", *kGoalTree = "#9a6700", *kCache = "#8250df", *kCell = "#2da44e",
                     *kPath = "#57606a", *kSmoothed = "#cf222e", *kStart = "#137a3a";

std::string stroke(const char* colour, double width_px, const char* more = "") {
  return fmt::format("stroke='{}' stroke-width='{}'{}", colour, width_px, more);
}

std::vector<LegendEntry> legend_of(const PlanDrawing& drawing, bool has_path) {
  std::vector<LegendEntry> legend{
      dot_entry("start", fmt::format("fill='{}'", kStart)),
      dot_entry("goal", "fill='none' " + stroke(kSmoothed, 3)),
      area_entry("obstacle", fmt::format("fill='{}'", kObstacleColour)),
  };
  if (has_path) {
    legend.push_back(line_entry("path", stroke(kPath, 3, " stroke-dasharray='6 4'")));
    legend.push_back(line_entry("smoothed path", stroke(kSmoothed, 4)));
  }
  if (!drawing.tree.empty()) legend.push_back(line_entry("explored", stroke(kTree, 1.5)));
  if (!drawing.goal_tree.empty())
    legend.push_back(line_entry("explored from the goal, or equal cost", stroke(kGoalTree, 1.5)));
  if (!drawing.cells.empty()) legend.push_back(area_entry("cell", "fill='#dafbe1' " + stroke(kCell, 1)));
  if (!drawing.cache.empty())
    legend.push_back(dot_entry("waypoint cache", fmt::format("fill='{}'", kCache), 4));
  if (!drawing.band.empty())
    legend.push_back(dot_entry(
        "band", fmt::format("fill='{0}' fill-opacity='0.15' {1}", kGoalTree, stroke(kGoalTree, 1))));
  return legend;
}

}  // namespace

std::string plan_picture(const PlanWorld& world, const PlanQuery& query, const PlanDrawing& drawing,
                         const std::vector<Vec2>& path_m, const std::vector<Vec2>& smoothed_m,
                         const std::string& subtitle) {
  const Vec2 corner_m = Vec2(world.field.length_m, world.field.width_m) / 2;
  FloorSheet sheet;
  sheet.view = sheet_view({-corner_m, corner_m});
  sheet.title = world.name;
  sheet.subtitle = subtitle;
  const FloorView& view = sheet.view;
  std::string& svg = sheet.floor;
  for (const ConvexPolygon& cell : drawing.cells)
    svg += svg_polygon(view, cell.corners_m, "fill='#dafbe1' " + stroke(kCell, 0.5));
  for (const Shape& shape : world.obstacles) svg += svg_obstacle(view, shape);
  svg += svg_segments(view, drawing.tree, stroke(kTree, 1)) +
         svg_segments(view, drawing.goal_tree, stroke(kGoalTree, 1));
  for (const Vec2& point : drawing.cache)
    svg += svg_disc(view, point, 0.03, fmt::format("fill='{}'", kCache));
  for (const Circle& bubble : drawing.band)
    svg += svg_disc(view, bubble.centre_m, bubble.radius_m,
                    fmt::format("fill='{0}' fill-opacity='0.15' stroke='{0}'", kGoalTree));
  svg += svg_polyline(view, path_m, stroke(kPath, 3, " stroke-dasharray='6 4'")) +
         svg_polyline(view, smoothed_m, stroke(kSmoothed, 4));
  svg += svg_disc(view, query.start_m, world.radius_m, fmt::format("fill='{}'", kStart)) +
         svg_disc(view, query.goal_m, world.radius_m, "fill='none' " + stroke(kSmoothed, 3));
  sheet.legend = legend_of(drawing, !path_m.empty());
  return svg_sheet(sheet);
}

}  // namespace sidestep
