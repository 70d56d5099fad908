// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_picture.hpp"

#include <fmt/format.h>

#include "common/collision/obstacle_world.hpp"
#include "common/svg/floor_sheet.hpp"

namespace sidestep {
namespace {

constexpr double kArrowSpacing_m = 0.2, kArrow_m = 0.14;
// Minimum distance between drawn points of a path.
constexpr double kPathStep_m = 0.02;

std::string arrows(const FloorView& view, const PlanWorld& world, const DriveDirection& field) {
  const ObstacleWorld obstacles(world.obstacles);
  std::string lines;
  for (double y = -world.field.width_m / 2; y < world.field.width_m / 2; y += kArrowSpacing_m)
    for (double x = -world.field.length_m / 2; x < world.field.length_m / 2; x += kArrowSpacing_m) {
      const Vec2 at(x, y);
      if (obstacles.touches(at, world.radius_m)) continue;
      const Vec2 tip = at + kArrow_m * field(at), back = kArrow_m / 3 * field(at);
      const std::vector<Vec2> arrow{at, tip, tip - rotated(back, 0.5), tip, tip - rotated(back, -0.5)};
      lines += svg_polyline(view, arrow, "");
    }
  return fmt::format("<g stroke='#8b949e'>\n{}</g>\n", lines);
}

std::vector<Vec2> thinned(const std::vector<Vec2>& path_m) {
  std::vector<Vec2> result{path_m.front()};
  for (const Vec2& p : path_m)
    if ((p - result.back()).norm() >= kPathStep_m) result.push_back(p);
  result.push_back(path_m.back());
  return result;
}

}  // namespace

std::string field_picture(const PlanWorld& world, const DriveDirection& field,
                          const std::vector<PicturePath>& paths) {
  const Vec2 corner_m = Vec2(world.field.length_m, world.field.width_m) / 2;
  FloorSheet sheet;
  sheet.view = sheet_view({-corner_m, corner_m});
  sheet.title = world.name;
  sheet.subtitle = "directions of the field, and where robots that follow each method drive";
  sheet.floor = arrows(sheet.view, world, field);
  for (const Shape& obstacle : world.obstacles) sheet.floor += svg_obstacle(sheet.view, obstacle);
  for (const PicturePath& path : paths) {
    const std::string stroke = fmt::format("stroke='{}' stroke-width='4'", path.colour);
    sheet.floor += svg_polyline(sheet.view, thinned(path.path_m), stroke) +
                   svg_disc(sheet.view, path.path_m.back(), world.radius_m, "fill='none' " + stroke);
    sheet.legend.push_back(line_entry(path.title, stroke));
  }
  const PlanQuery& query = world.queries.front();
  sheet.floor += svg_disc(sheet.view, query.start_m, world.radius_m, "fill='#2da44e'") +
                 svg_disc(sheet.view, query.goal_m, 0.05, "fill='#222222'");
  sheet.legend.push_back(dot_entry("start", "fill='#2da44e'"));
  sheet.legend.push_back(dot_entry("goal", "fill='#222222'", 4));
  return svg_sheet(sheet);
}

}  // namespace sidestep
