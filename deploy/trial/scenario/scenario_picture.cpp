// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/scenario/scenario_picture.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

#include "deploy/trial/shape_picture.hpp"

namespace sidestep {
namespace {

constexpr double kWidth_px = 1200, kFrame_px = 30;
constexpr const char *kBlue = "#1f6feb", *kYellow = "#9a6700", *kRed = "#cf222e";

/// Draws in pixels, relative to the middle of the floor.
class Picture {
 public:
  explicit Picture(const Scenario& scenario)
      : scenario_(scenario),
        pixels_per_metre_(kWidth_px / std::max(scenario.field.length_m, scenario.field.width_m)),
        // In a wide hall, a robot to scale would be too small to read its number.
        robot_px_(std::max(9.0, pixels_per_metre_ * scenario.radius_m)) {}

  std::string svg() const {
    const double length = pixels_per_metre_ * scenario_.field.length_m,
                 width = pixels_per_metre_ * scenario_.field.width_m;
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='{:.1f} {:.1f} {:.1f} {:.1f}' "
        "font-family='sans-serif' "
        "font-size='14'>\n<title>{}</title>\n<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' "
        "fill='#f6f8fa' stroke='#8b949e' stroke-width='2'/>\n",
        -length / 2 - kFrame_px, -width / 2 - kFrame_px, length + 2 * kFrame_px, width + 2 * kFrame_px + 20,
        scenario_.name, -length / 2, -width / 2, length, width);
    for (const Shape& obstacle : scenario_.obstacles) svg += svg_obstacle(obstacle, pixels_per_metre_);
    if (scenario_.map)
      for (const Box& cells : scenario_.map->rectangles()) svg += svg_obstacle(cells, pixels_per_metre_);
    for (const OpponentSpec& opponent : scenario_.opponents) svg += opponent_mark(opponent);
    for (const RobotSpec& robot : scenario_.robots) svg += way(robot);
    for (const RobotSpec& robot : scenario_.robots) svg += start(robot);
    return svg + scale(-length / 2, width / 2) + "</svg>\n";
  }

 private:
  static const char* colour_of(const RobotSpec& robot) { return robot.team == Team::kBlue ? kBlue : kYellow; }

  std::string disc(const Vec2& at_m, double radius_px, const std::string& style) const {
    return svg_disc(at_m, radius_px / pixels_per_metre_, style, pixels_per_metre_);
  }
  std::string polyline(const std::vector<Vec2>& points_m, const std::string& style) const {
    return fmt::format("<polyline points='{}' fill='none' {}/>\n", svg_points(points_m, pixels_per_metre_),
                       style);
  }
  std::string text(const Vec2& at_m, RobotId robot, const char* colour) const {
    return fmt::format(
        "<text x='{:.1f}' y='{:.1f}' dy='0.35em' text-anchor='middle' font-size='{:.1f}' "
        "fill='{}'>{}</text>\n",
        pixels_per_metre_ * at_m.x(), -pixels_per_metre_ * at_m.y(), 1.1 * robot_px_, colour, robot);
  }

  std::string opponent_mark(const OpponentSpec& opponent) const {
    return polyline(opponent.path_m, fmt::format("stroke='{}' stroke-dasharray='6 6'", kRed)) +
           disc(opponent.path_m.front(), pixels_per_metre_ * opponent.radius_m,
                fmt::format("fill='{}' fill-opacity='0.7'", kRed));
  }

  /// Dashed lines through the goals, and the last one as a ring with the robot's number.
  std::string way(const RobotSpec& robot) const {
    if (robot.goals.empty()) return "";
    std::vector<Vec2> points_m{robot.start_m};
    for (const Goal& goal : robot.goals) points_m.push_back(goal.position_m);
    const char* const colour = colour_of(robot);
    std::string svg =
        polyline(points_m, fmt::format("stroke='{}' stroke-opacity='0.5' stroke-dasharray='3 5'", colour));
    for (std::size_t i = 1; i + 1 < points_m.size(); ++i)
      svg += disc(points_m[i], 4, fmt::format("fill='{}'", colour));
    return svg +
           disc(points_m.back(), robot_px_,
                fmt::format("fill='white' stroke='{}' stroke-width='2'", colour)) +
           text(points_m.back(), robot.id, colour);
  }

  std::string start(const RobotSpec& robot) const {
    const char* const colour = colour_of(robot);
    const Vec2 ahead_m = 1.7 * robot_px_ / pixels_per_metre_ * rotated(Vec2(1, 0), robot.start_heading_rad);
    return polyline({robot.start_m, robot.start_m + ahead_m},
                    fmt::format("stroke='{}' stroke-width='3'", colour)) +
           disc(robot.start_m, robot_px_, fmt::format("fill='{}'", colour)) +
           text(robot.start_m, robot.id, "white");
  }

  /// The length of a metre, and what the marks mean, below the floor.
  std::string scale(double left_px, double bottom_px) const {
    const double y = bottom_px + kFrame_px;
    return fmt::format(
        "<path d='M{0:.1f} {1:.1f}v6h{2:.1f}v-6' fill='none' stroke='#24292f'/>\n"
        "<text x='{3:.1f}' y='{4:.1f}' fill='#24292f'>1 m   disc: start and direction   ring: last goal   "
        "dot: earlier goal{5}</text>\n",
        left_px, y - 6, pixels_per_metre_, left_px + pixels_per_metre_ + 12, y + 4,
        scenario_.opponents.empty() ? "" : "   red: moving obstacles");
  }

  const Scenario& scenario_;
  double pixels_per_metre_, robot_px_;
};

}  // namespace

std::string scenario_picture(const Scenario& scenario) { return Picture(scenario).svg(); }

}  // namespace sidestep
