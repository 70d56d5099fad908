// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_picture.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <vector>

#include "common/svg/floor_sheet.hpp"
#include "common/svg/svg.hpp"

namespace sidestep {
namespace {

constexpr double kMinRobot_px = 9;  // in a wide hall, a robot to scale would be too small to read its number
constexpr const char *kBlue = "#1f6feb", *kYellow = "#9a6700", *kRed = "#cf222e", *kNeutral = "#57606a";

const char* colour_of(const RobotSpec& robot) { return robot.team == Team::kBlue ? kBlue : kYellow; }

std::string fill(const char* colour) { return fmt::format("fill='{}'", colour); }

std::string stroke(const char* colour, double width_px, const char* more = "") {
  return fmt::format("stroke='{}' stroke-width='{}'{}", colour, width_px, more);
}

std::string ring(const char* colour) { return "fill='white' " + stroke(colour, 2); }

/// The robots of a scenario on the floor.
class RobotMarks {
 public:
  RobotMarks(const FloorView& view, double radius_m)
      : view_(view), radius_px_(std::max(kMinRobot_px, view.px(radius_m))) {}

  /// Dashed lines through the goals, and the last one as a ring with the robot's number.
  std::string way(const RobotSpec& robot) const {
    if (robot.goals.empty()) return "";
    std::vector<Vec2> points_m{robot.start_m};
    for (const Goal& goal : robot.goals) points_m.push_back(goal.position_m);
    const char* const colour = colour_of(robot);
    std::string svg =
        svg_polyline(view_, points_m, stroke(colour, 1, " stroke-opacity='0.5' stroke-dasharray='3 5'"));
    for (std::size_t i = 1; i + 1 < points_m.size(); ++i)
      svg += svg_circle(view_.px(points_m[i]), 4, fill(colour));
    return svg + svg_circle(view_.px(points_m.back()), radius_px_, ring(colour)) +
           number(points_m.back(), robot.id, colour);
  }

  std::string start(const RobotSpec& robot) const {
    const char* const colour = colour_of(robot);
    const Vec2 ahead_m =
        1.7 * radius_px_ / view_.pixels_per_metre * rotated(Vec2(1, 0), robot.start_heading_rad);
    return svg_polyline(view_, std::array<Vec2, 2>{robot.start_m, robot.start_m + ahead_m},
                        stroke(colour, 3)) +
           svg_circle(view_.px(robot.start_m), radius_px_, fill(colour)) +
           number(robot.start_m, robot.id, "white");
  }

 private:
  std::string number(const Vec2& at_m, RobotId robot, const char* colour) const {
    return svg_text(view_.px(at_m), std::to_string(robot),
                    fmt::format("dy='0.35em' text-anchor='middle' font-size='{:.1f}' {}", 1.1 * radius_px_,
                                fill(colour)));
  }

  const FloorView& view_;
  double radius_px_;
};

std::string opponent_mark(const FloorView& view, const OpponentSpec& opponent) {
  return svg_polyline(view, opponent.path_m, stroke(kRed, 1, " stroke-dasharray='6 6'")) +
         svg_disc(view, opponent.path_m.front(), opponent.radius_m, fill(kRed) + " fill-opacity='0.7'");
}

std::vector<LegendEntry> legend_of(const Scenario& scenario) {
  const auto any_goals = [&](std::size_t least) {
    return std::ranges::any_of(scenario.robots,
                               [least](const RobotSpec& robot) { return robot.goals.size() >= least; });
  };
  std::vector<LegendEntry> legend{
      {fmt::format("<path d='M9 9h16' {}/>", stroke(kNeutral, 3)) + svg_circle({9, 9}, 7, fill(kNeutral)),
       "start and direction", 30}};
  if (any_goals(1)) legend.push_back(dot_entry("last goal", ring(kNeutral)));
  if (any_goals(2)) legend.push_back(dot_entry("earlier goal", fill(kNeutral), 4));
  if (!scenario.obstacles.empty() || scenario.map)
    legend.push_back(area_entry("obstacle", fill(kObstacleColour)));
  if (!scenario.opponents.empty())
    legend.push_back(dot_entry("moving obstacle", fill(kRed) + " fill-opacity='0.7'"));
  return legend;
}

}  // namespace

std::string scenario_picture(const Scenario& scenario) {
  const Vec2 corner_m = Vec2(scenario.field.length_m, scenario.field.width_m) / 2;
  FloorSheet sheet;
  sheet.view = sheet_view({-corner_m, corner_m});
  sheet.title = scenario.name;
  sheet.subtitle = fmt::format("field of {:g} x {:g} m", scenario.field.length_m, scenario.field.width_m);
  sheet.legend = legend_of(scenario);
  std::string& svg = sheet.floor;
  for (const Shape& obstacle : scenario.obstacles) svg += svg_obstacle(sheet.view, obstacle);
  if (scenario.map) svg += svg_obstacles(sheet.view, scenario.map->rectangles());
  for (const OpponentSpec& opponent : scenario.opponents) svg += opponent_mark(sheet.view, opponent);
  const RobotMarks marks(sheet.view, scenario.radius_m);
  for (const RobotSpec& robot : scenario.robots) svg += marks.way(robot);
  for (const RobotSpec& robot : scenario.robots) svg += marks.start(robot);
  return svg_sheet(sheet);
}

}  // namespace sidestep
