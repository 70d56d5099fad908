// SPDX-License-Identifier: Apache-2.0
#include "agents/perception/laser_beams.hpp"

#include <fmt/format.h>
#include <stdexcept>

namespace sidestep {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;

}  // namespace

LaserBeams::LaserBeams(const LaserSettings& settings, double robot_tolerance_m)
    : scanner_(settings), robot_tolerance_m_(robot_tolerance_m) {
  if (!(robot_tolerance_m >= 0 && std::isfinite(robot_tolerance_m)))
    throw std::invalid_argument("the tolerance of robots in a scan must be finite and not negative");
  beams_.resize(static_cast<std::size_t>(settings.beams));
  const int last = settings.beams - 1;
  spacing_rad_ =
      last > 0 ? scanner_.beam_angle_rad(1) - scanner_.beam_angle_rad(0) : settings.field_of_view_rad;
  last_gap_rad_ = kTurn_rad - last * spacing_rad_;
  for (int beam = 0; beam < settings.beams; ++beam)
    directions_.push_back(rotated({1, 0}, scanner_.beam_angle_rad(beam)));
}

Beam LaserBeams::interpreted(float range_m, const Vec2& direction, std::span<const Circle> robots) const {
  if (!(range_m >= settings().min_range_m)) return {direction, 0, BeamEnd::kUnknown};
  if (range_m > settings().max_range_m) return {direction, settings().max_range_m, BeamEnd::kClear};
  const Beam hit{direction, range_m, BeamEnd::kHit};
  const Vec2 end = end_m(hit);
  for (const Circle& robot : robots)
    if (touch(robot, {end, robot_tolerance_m_})) return {direction, range_m, BeamEnd::kRobot};
  return hit;
}

void LaserBeams::read(const LaserScan& scan, std::span<const Circle> robots) {
  if (!scan.at_m.allFinite() || !std::isfinite(scan.heading_rad))
    throw std::invalid_argument("the pose of a scan must be finite");
  if (scan.ranges_m.size() != beams_.size())
    throw std::invalid_argument(fmt::format("got a scan with {} ranges, expected one for each of {} beams",
                                            scan.ranges_m.size(), beams_.size()));
  for (const Circle& robot : robots) {
    if (!robot.centre_m.allFinite() || !std::isfinite(robot.radius_m) || robot.radius_m < 0)
      throw std::invalid_argument("a robot in a scan must be finite, with a radius that is not negative");
  }
  at_m_ = scan.at_m;
  captured_at_ = scan.captured_at;
  const Vec2 heading = rotated({1, 0}, scan.heading_rad);
  for (std::size_t i = 0; i < beams_.size(); ++i) {
    const Vec2 direction = directions_[i].x() * heading + directions_[i].y() * left_of(heading);
    beams_[i] = interpreted(scan.ranges_m[i], direction, robots);
  }
}

}  // namespace sidestep
