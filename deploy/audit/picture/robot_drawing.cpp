// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/picture/robot_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "common/svg/axis.hpp"
#include "common/svg/svg.hpp"

namespace sidestep {
namespace {

constexpr double kLegible_px = 9, kSmallest_px = 3, kNumbered_px = 6.5;  // radii of discs
constexpr double kSpacingPerDisc = 5;  // of evenly spread robots, in radii of small discs
constexpr std::size_t kFewRobots = 60;
constexpr double kArrowSpacing_px = 45, kArrow_px = 6;
constexpr double kMaxArrows = 1000;                     // of one robot
constexpr double kStartRadii = 1.25, kGoalRadii = 1.7;  // of marks, in radii of a disc, which hides neither
constexpr double kMoving_px = 3;  // a robot that moves less between two moments has no direction

/// The robot's places from the begin of the animation on.
std::vector<TimedPlace> places_of(const FloorTrace::Robot& robot, const FloorView& view,
                                  const RunTiming& timing) {
  std::vector<TimedPlace> places{{timing.begin_s, view.px(position_at(robot.path, timing.begin_s))}};
  for (const FloorTrace::Point& point : robot.path)
    if (point.at_s > timing.begin_s) places.push_back({point.at_s, view.px(point.position_m)});
  return places;
}

std::string arrows(const FloorTrace::Robot& robot, const RobotStyle& style, const FloorView& view,
                   const RunTiming& timing) {
  const double from_s = std::max(robot.path.front().at_s, timing.begin_s), to_s = robot.path.back().at_s,
               half_s = 0.1 * style.arrow_period_s;
  std::string data;
  for (const double at_s : ticks(from_s + half_s, to_s - half_s, style.arrow_period_s)) {
    const Vec2 before = view.px(position_at(robot.path, at_s - half_s)),
               after = view.px(position_at(robot.path, at_s + half_s));
    if ((after - before).norm() < kMoving_px) continue;
    data += svg_arrow_data((before + after) / 2, after - before, kArrow_px);
  }
  return data;
}

/// The path, faint if its driven part is drawn over it.
std::string path_of(const FloorTrace::Robot& robot, const std::string& colour, const RobotStyle& style,
                    const FloorView& view, const RunTiming& timing) {
  const std::vector<TimedPlace> places = places_of(robot, view, timing);
  std::vector<Vec2> points;
  std::vector<double> at_s, driven_px;
  for (const TimedPlace& place : places) {
    driven_px.push_back(points.empty() ? 0 : driven_px.back() + (place.px - points.back()).norm());
    points.push_back(place.px);
    at_s.push_back(place.at_s);
  }
  if (driven_px.back() < 1) return {};
  const std::string line =
      fmt::format("<path d='{}' stroke-width='{}'", svg_path_data(points), style.line_px);
  std::string lines;
  if (style.has_trails && timing.plays()) {
    // A dash as long as the path, which an offset hides as far as the robot has not driven yet. Viewers
    // without animation show all of it.
    const double dash_px = driven_px.back() + 1;
    std::vector<std::string> offsets;
    for (const double driven : driven_px) offsets.push_back(fmt::format("{:.1f}", dash_px - driven));
    offsets.back() = "0";
    lines =
        line + " stroke-opacity='0.3'/>\n" +
        fmt::format("{} stroke-dasharray='{:.1f}'><animate attributeName='stroke-dashoffset' {}/></path>\n",
                    line, dash_px, animation_attributes(timing, at_s, offsets));
  } else {
    lines = line + " stroke-opacity='0.85'/>\n";
  }
  const std::string heads = arrows(robot, style, view, timing);
  return fmt::format(
             "<g fill='none' stroke='{0}' stroke-linejoin='round'><title>path of robot {1}</title>\n{2}",
             colour, robot.id, lines) +
         (heads.empty()
              ? ""
              : fmt::format("<path d='{}' fill='{}' stroke='white' stroke-width='0.8'/>\n", heads, colour)) +
         "</g>\n";
}

std::string start_mark(const FloorTrace::Robot& robot, const std::string& colour, const RobotStyle& style,
                       const FloorView& view) {
  return fmt::format(
      "<path d='{}' fill='white' fill-opacity='0.3' stroke='{}' stroke-width='{}' stroke-dasharray='4 3'>"
      "<title>start of robot {}</title></path>\n",
      svg_ring_data(view.px(robot.start_m), kStartRadii * style.disc_px), colour, style.mark_px, robot.id);
}

std::string goal_marks(const FloorTrace::Robot& robot, const std::string& colour, const RobotStyle& style,
                       const FloorView& view) {
  std::string svg;
  for (std::size_t i = 0; i < robot.goals_m.size(); ++i) {
    const Vec2 at = view.px(robot.goals_m[i]);
    const double radius_px = kGoalRadii * style.disc_px;
    const std::string name =
        robot.goals_m.size() == 1 ? fmt::format("{}", robot.id) : fmt::format("{}.{}", robot.id, i + 1);
    svg += fmt::format(
        "<path d='{}' fill='white' fill-opacity='0.75' stroke='{}' stroke-width='{}'><title>goal "
        "{}</title></path>\n",
        goal_mark_data(at, radius_px), colour, style.mark_px, name);
    if (!style.has_numbers) continue;
    svg +=
        svg_text({at.x(), at.y() - radius_px - 3}, name,
                 fmt::format("font-size='11' text-anchor='middle' fill='{}' stroke='white' stroke-width='3' "
                             "paint-order='stroke'",
                             colour));
  }
  return svg;
}

std::string disc_of(const FloorTrace::Robot& robot, const std::string& colour, const RobotStyle& style) {
  const std::string number = std::to_string(robot.id);
  const double fitting_px = 1.9 * style.disc_px / (0.62 * static_cast<double>(number.size()));
  const double font_px = std::min(std::max(fitting_px, 7.0), 1.15 * style.disc_px);
  std::string svg =
      svg_circle({0, 0}, style.disc_px,
                 fmt::format("fill='{}' stroke='{}' stroke-width='{}'", colour,
                             style.has_teams ? colour_of(robot.team) : "white", style.has_teams ? 2.5 : 1));
  if (style.has_numbers)
    svg += fmt::format("<text y='{:.1f}' text-anchor='middle' fill='white' font-size='{:.1f}'>{}</text>\n",
                       0.35 * font_px, font_px, number);
  return svg;
}

}  // namespace

const char* colour_of(Team team) { return team == Team::kBlue ? "#4aa3ff" : "#f2b800"; }

std::string goal_mark_data(const Vec2& centre_px, double radius_px) {
  return fmt::format("M{:.1f} {:.1f}l{r:.1f} {r:.1f}l-{r:.1f} {r:.1f}l-{r:.1f} -{r:.1f}z", centre_px.x(),
                     centre_px.y() - radius_px, fmt::arg("r", radius_px));
}

RobotStyle robot_style(const FloorTrace& trace, const FloorView& view, const RunTiming& timing) {
  const std::size_t robots = std::max<std::size_t>(1, trace.robots.size());
  const Vec2 size = view.size_px();
  const double spacing_px = std::sqrt(size.x() * size.y() / static_cast<double>(robots));
  RobotStyle style;
  const double true_px = view.px(trace.radius_m);
  style.disc_px = std::max(true_px, std::clamp(spacing_px / kSpacingPerDisc, kSmallest_px, kLegible_px));
  style.enlargement = style.disc_px / true_px;
  style.has_numbers = style.disc_px >= kNumbered_px;
  style.has_trails = robots <= kFewRobots;
  style.line_px = robots <= kFewRobots ? 2.5 : 1.2;
  style.mark_px = robots <= kFewRobots ? 2 : 1;
  const auto is_yellow = [](const FloorTrace::Robot& robot) { return robot.team == Team::kYellow; };
  style.has_teams =
      std::ranges::any_of(trace.robots, is_yellow) && !std::ranges::all_of(trace.robots, is_yellow);
  double driven_px = 0, moving_s = 0;
  for (const FloorTrace::Robot& robot : trace.robots) {
    for (std::size_t i = 1; i < robot.path.size(); ++i) {
      const double step_px = view.px((robot.path[i].position_m - robot.path[i - 1].position_m).norm());
      if (step_px < 1) continue;
      driven_px += step_px;
      moving_s += robot.path[i].at_s - robot.path[i - 1].at_s;
    }
  }
  if (driven_px > 0 && moving_s > 0) style.arrow_period_s = kArrowSpacing_px * moving_s / driven_px;
  style.arrow_period_s =
      round_step(std::max(style.arrow_period_s, (timing.end_s - timing.begin_s) / kMaxArrows));
  return style;
}

RobotDrawing draw_robot(const FloorTrace::Robot& robot, const std::string& colour, const RobotStyle& style,
                        const FloorView& view, const RunTiming& timing) {
  RobotDrawing drawing;
  drawing.goals = goal_marks(robot, colour, style, view);
  drawing.start = start_mark(robot, colour, style, view);
  if (robot.path.empty()) return drawing;
  drawing.path = path_of(robot, colour, style, view, timing);
  const Vec2 end = view.px(robot.path.back().position_m);
  drawing.disc = fmt::format("<g transform='translate({:.1f},{:.1f})'><title>robot {}</title>{}{}</g>\n",
                             end.x(), end.y(), robot.id, disc_of(robot, colour, style),
                             timing.plays() ? svg_motion(timing, places_of(robot, view, timing)) : "");
  return drawing;
}

}  // namespace sidestep
