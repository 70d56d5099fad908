// SPDX-License-Identifier: Apache-2.0
#include "tests/study/potential/field_picture.hpp"

#include <fmt/format.h>

#include "common/collision/obstacle_world.hpp"
#include "deploy/trial/shape_picture.hpp"

namespace sidestep {
namespace {

constexpr double kPixels_pm = 100;
constexpr double kArrowSpacing_m = 0.2, kArrow_m = 0.14;
// Minimum distance between drawn points of a path.
constexpr double kPathStep_m = 0.02;

std::string arrows(const PlanWorld& world, const DriveDirection& field) {
  const ObstacleWorld obstacles(world.obstacles);
  std::string lines;
  for (double y = -world.field.width_m / 2; y < world.field.width_m / 2; y += kArrowSpacing_m)
    for (double x = -world.field.length_m / 2; x < world.field.length_m / 2; x += kArrowSpacing_m) {
      const Vec2 at(x, y);
      if (obstacles.touches(at, world.radius_m)) continue;
      const Vec2 tip = at + kArrow_m * field(at), back = kArrow_m / 3 * field(at);
      const std::vector<Vec2> arrow{at, tip, tip - rotated(back, 0.5), tip, tip - rotated(back, -0.5)};
      lines += fmt::format("<polyline points='{}'/>\n", svg_points(arrow, kPixels_pm));
    }
  return fmt::format("<g fill='none' stroke='#8b949e' stroke-width='1'>\n{}</g>\n", lines);
}

std::vector<Vec2> thinned(const std::vector<Vec2>& path_m) {
  std::vector<Vec2> result{path_m.front()};
  for (const Vec2& p : path_m)
    if ((p - result.back()).norm() >= kPathStep_m) result.push_back(p);
  result.push_back(path_m.back());
  return result;
}

std::string legend(const PlanWorld& world, const std::vector<PicturePath>& paths) {
  std::string text;
  double y = -kPixels_pm * world.field.width_m / 2 + 24;
  const double x = -kPixels_pm * world.field.length_m / 2 + 16;
  for (const PicturePath& path : paths) {
    text += fmt::format(
        "<text x='{:.0f}' y='{:.0f}' fill='{}' font-family='sans-serif' font-size='20' "
        "stroke='white' stroke-width='5' paint-order='stroke'>{}</text>\n",
        x, y, path.colour, path.title);
    y += 26;
  }
  return text;
}

}  // namespace

std::string field_picture(const PlanWorld& world, const DriveDirection& field,
                          const std::vector<PicturePath>& paths) {
  const double width = kPixels_pm * world.field.length_m, height = kPixels_pm * world.field.width_m;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='{0:.1f} {1:.1f} {2:.1f} {3:.1f}'>\n<rect x='{0:.1f}' "
      "y='{1:.1f}' width='{2:.1f}' height='{3:.1f}' fill='#f6f8fa'/>\n",
      -width / 2, -height / 2, width, height);
  svg += arrows(world, field);
  for (const Shape& shape : world.obstacles) svg += svg_obstacle(shape, kPixels_pm);
  for (const PicturePath& path : paths)
    svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='4'/>\n",
                       svg_points(thinned(path.path_m), kPixels_pm), path.colour) +
           svg_disc(path.path_m.back(), world.radius_m,
                    fmt::format("fill='none' stroke='{}' stroke-width='3'", path.colour), kPixels_pm);
  svg += svg_disc(world.queries.front().start_m, world.radius_m, "fill='#2da44e'", kPixels_pm);
  svg += svg_disc(world.queries.front().goal_m, 0.05, "fill='#222222'", kPixels_pm);
  return svg + legend(world, paths) + "</svg>\n";
}

}  // namespace sidestep
