// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/laser_picture.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <stdexcept>

#include "common/svg/palette.hpp"
#include "common/svg/svg.hpp"

namespace sidestep {
namespace {

constexpr double kMinDisc_px = 9;  // radius of a legible robot
constexpr const char *kSeen = "#2da44e", *kHidden = "#cf222e", *kMoving = "#bf8700", *kAtRest = "#8b949e",
                     *kUnknown = "#8250df", *kOccupied = "#24292f", *kOtherRobot = "#57606a";

const LaserSpec& laser_of(const Scenario& scenario, RobotId robot) {
  if (!scenario.laser) throw std::invalid_argument("the scenario's robots have no laser");
  if (!find_robot(scenario, robot))
    throw std::invalid_argument(fmt::format("the scenario has no robot {}", robot));
  return *scenario.laser;
}

Box field_of(const Scenario& scenario) {
  const Vec2 corner_m = Vec2(scenario.field.length_m, scenario.field.width_m) / 2;
  return {-corner_m, corner_m};
}

std::string fill(const char* colour, double opacity) {
  return fmt::format("fill='{}' fill-opacity='{}'", colour, opacity);
}

std::vector<LegendEntry> legend() {
  return {dot_entry("the robot that looks", fmt::format("fill='{}'", distinct_colour(0))),
          dot_entry("other robot", fmt::format("fill='{}'", kOtherRobot)),
          area_entry("seen by the laser", fill(kSeen, 0.3)),
          area_entry("hit", fill(kOccupied, 0.6)),
          line_entry("people may step out here", fmt::format("stroke='{}' stroke-width='4'", kHidden)),
          area_entry("not known", fill(kUnknown, 0.3)),
          dot_entry("moves", fmt::format("fill='none' stroke='{}' stroke-width='4'", kMoving)),
          dot_entry("rests", fmt::format("fill='none' stroke='{}' stroke-width='4'", kAtRest))};
}

}  // namespace

LaserPicture::LaserPicture(const Scenario& scenario, RobotId robot)
    : scenario_(scenario),
      robot_(robot),
      view_(sheet_view(field_of(scenario))),
      rules_(floor_rules(scenario)),
      decoder_(robot, laser_of(scenario, robot).settings),
      sight_(*scenario.laser, rules_, {.position_error_m = scenario.tracking_bound_m}) {}

void LaserPicture::add(const msg::GroundTruth& truth) {
  for (const msg::TrueRobotState& robot : truth.robots())
    robots_m_[robot.robot()] = {robot.x_m(), robot.y_m()};
}

void LaserPicture::add(const msg::LaserScan& message) {
  const auto scan = decoder_.decode(message, time_from_ns(message.header().stamp_ns()));
  if (!scan) return;
  std::vector<Circle> others;
  for (const auto& [robot, at_m] : robots_m_)
    if (robot != robot_) others.push_back({at_m, scenario_.radius_m});
  sight_.update(*scan, others);
}

std::string LaserPicture::svg_grid() const {
  std::vector<Box> hits;
  const LocalGrid& grid = sight_.grid();
  grid.for_each_occupied(field_of(scenario_), [&](const Cell& cell) { hits.push_back(grid.box_of(cell)); });
  std::string svg;
  for (const Box& hit : hits) {
    const Vec2 corner = view_.px(Vec2(hit.min_m.x(), hit.max_m.y())),
               size = view_.pixels_per_metre * (hit.max_m - hit.min_m);
    svg += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' {}/>\n", corner.x(),
                       corner.y(), size.x(), size.y(), fill(kOccupied, 0.6));
  }
  for (const Circle& square : sight_.unknown())
    svg += svg_disc(view_, square.centre_m, square.radius_m, fill(kUnknown, 0.15));
  return svg;
}

std::string LaserPicture::svg_scan() const {
  std::vector<Vec2> ends_m;
  const LaserBeams& beams = sight_.beams();
  for (const Beam& beam : beams.all()) ends_m.push_back(beams.end_m(beam));
  std::string svg = svg_polygon(view_, ends_m, fill(kSeen, 0.15));
  for (const Frontier& frontier : sight_.visibility().frontiers())
    svg += svg_segments(view_, std::array{frontier.segment},
                        fmt::format("stroke='{}' stroke-width='4' stroke-linecap='round'", kHidden));
  return svg;
}

std::string LaserPicture::svg_people() const {
  std::string svg;
  for (const LaserTrack& track : sight_.tracks()) {
    const std::string stroke =
        fmt::format("stroke='{}' stroke-width='4'", track.is_moving ? kMoving : kAtRest);
    svg += svg_disc(view_, track.position_m, track.radius_m, "fill='none' " + stroke);
    if (track.is_moving)
      svg += svg_segments(view_, std::array{Segment{track.position_m, track.position_m + track.velocity_mps}},
                          stroke);
  }
  return svg;
}

std::string LaserPicture::svg_robots() const {
  std::string svg;
  const double disc_px = std::max(kMinDisc_px, view_.px(scenario_.radius_m));
  for (const RobotSpec& robot : scenario_.robots) {
    const auto at = robots_m_.find(robot.id);
    if (at == robots_m_.end()) continue;
    const Vec2 centre = view_.px(at->second);
    svg += svg_circle(centre, disc_px,
                      fmt::format("fill='{}'", robot.id == robot_ ? distinct_colour(0) : kOtherRobot)) +
           svg_text({centre.x(), centre.y() + 4}, std::to_string(robot.id),
                    "text-anchor='middle' fill='white' font-size='11'");
  }
  return svg;
}

std::string LaserPicture::svg() const {
  FloorSheet sheet;
  sheet.view = view_;
  sheet.title = fmt::format("{}: what the laser of robot {} shows", scenario_.name, robot_);
  sheet.subtitle = "at the end of the run";
  if (scenario_.map) sheet.floor += svg_obstacles(view_, scenario_.map->rectangles());
  for (const Shape& obstacle : scenario_.obstacles) sheet.floor += svg_obstacle(view_, obstacle);
  if (sight_.captured_at() != Time{}) sheet.floor += svg_scan() + svg_grid() + svg_people();
  sheet.floor += svg_robots();
  sheet.legend = legend();
  return svg_sheet(sheet);
}

}  // namespace sidestep
