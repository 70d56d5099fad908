// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/laser_picture.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "deploy/trial/shape_picture.hpp"
#include "deploy/trial/simulate/floor_picture.hpp"

namespace sidestep {
namespace {

const LaserSpec& laser_of(const Scenario& scenario, RobotId robot) {
  if (!scenario.laser) throw std::invalid_argument("the scenario's robots have no laser");
  if (!find_robot(scenario, robot))
    throw std::invalid_argument(fmt::format("the scenario has no robot {}", robot));
  return *scenario.laser;
}

std::string svg_line(const Vec2& from_m, const Vec2& to_m, const char* colour, double width) {
  return fmt::format(
      "<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' stroke='{}' stroke-width='{}' "
      "stroke-linecap='round'/>\n",
      kPixelsPerMetre * from_m.x(), -kPixelsPerMetre * from_m.y(), kPixelsPerMetre * to_m.x(),
      -kPixelsPerMetre * to_m.y(), colour, width);
}

std::string svg_square(const Box& box, const char* colour, double opacity) {
  const Vec2 size = box.max_m - box.min_m;
  return fmt::format(
      "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}' fill-opacity='{}'/>\n",
      kPixelsPerMetre * box.min_m.x(), -kPixelsPerMetre * box.max_m.y(), kPixelsPerMetre * size.x(),
      kPixelsPerMetre * size.y(), colour, opacity);
}

}  // namespace

LaserPicture::LaserPicture(const Scenario& scenario, RobotId robot)
    : scenario_(scenario),
      robot_(robot),
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
  std::string svg;
  const LocalGrid& grid = sight_.grid();
  const Box floor{{-scenario_.field.length_m / 2, -scenario_.field.width_m / 2},
                  {scenario_.field.length_m / 2, scenario_.field.width_m / 2}};
  grid.for_each_occupied(floor,
                         [&](const Cell& cell) { svg += svg_square(grid.box_of(cell), "#24292f", 0.6); });
  for (const Circle& square : sight_.unknown())
    svg += svg_disc(square.centre_m, square.radius_m, "fill='#8250df' fill-opacity='0.15'", kPixelsPerMetre);
  return svg;
}

std::string LaserPicture::svg_scan() const {
  const LaserBeams& beams = sight_.beams();
  std::string points;
  for (const Beam& beam : beams.all()) {
    const Vec2 end = beams.end_m(beam);
    points += fmt::format("{:.1f},{:.1f} ", kPixelsPerMetre * end.x(), -kPixelsPerMetre * end.y());
  }
  std::string svg = fmt::format("<polygon points='{}' fill='#2da44e' fill-opacity='0.15'/>\n", points);
  for (const Frontier& frontier : sight_.visibility().frontiers())
    svg += svg_line(frontier.segment.from_m, frontier.segment.to_m, "#cf222e", 4);
  return svg;
}

std::string LaserPicture::svg_people() const {
  std::string svg;
  for (const LaserTrack& track : sight_.tracks()) {
    const char* colour = track.is_moving ? "#bf8700" : "#8b949e";
    svg += svg_disc(track.position_m, track.radius_m,
                    fmt::format("fill='none' stroke='{}' stroke-width='5'", colour), kPixelsPerMetre);
    if (track.is_moving) svg += svg_line(track.position_m, track.position_m + track.velocity_mps, colour, 5);
  }
  return svg;
}

std::string LaserPicture::svg() const {
  std::string svg = svg_floor(scenario_);
  if (sight_.captured_at() != Time{}) svg += svg_scan() + svg_grid() + svg_people();
  for (const RobotSpec& robot : scenario_.robots)
    if (const auto at = robots_m_.find(robot.id); at != robots_m_.end())
      svg += svg_robot(scenario_, robot, at->second);
  return svg + "</svg>\n";
}

}  // namespace sidestep
