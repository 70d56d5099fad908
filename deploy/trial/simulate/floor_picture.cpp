// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/floor_picture.hpp"

#include <fmt/format.h>

#include "deploy/trial/shape_picture.hpp"

namespace sidestep {

std::string svg_floor(const Scenario& scenario) {
  const double width = kPixelsPerMetre * scenario.field.length_m,
               height = kPixelsPerMetre * scenario.field.width_m;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='{:.1f} {:.1f} {:.1f} {:.1f}' "
      "font-family='sans-serif' "
      "font-size='{:.0f}'>\n<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='#f6f8fa' "
      "stroke='#8b949e' stroke-width='4'/>\n",
      -width / 2, -height / 2, width, height, kPixelsPerMetre * scenario.radius_m, -width / 2, -height / 2,
      width, height);
  for (const Shape& obstacle : scenario.obstacles) svg += svg_obstacle(obstacle, kPixelsPerMetre);
  if (scenario.map)
    for (const Box& cells : scenario.map->rectangles()) svg += svg_obstacle(cells, kPixelsPerMetre);
  return svg;
}

const char* colour_of(Team team) { return team == Team::kBlue ? "#1f6feb" : "#e0a100"; }

std::string svg_robot(const Scenario& scenario, const RobotSpec& robot, const Vec2& at_m) {
  return svg_disc(at_m, scenario.radius_m, fmt::format("fill='{}'", colour_of(robot.team)), kPixelsPerMetre) +
         fmt::format("<text x='{:.1f}' y='{:.1f}' dy='0.35em' text-anchor='middle' fill='white'>{}</text>\n",
                     kPixelsPerMetre * at_m.x(), -kPixelsPerMetre * at_m.y(), robot.id);
}

}  // namespace sidestep
