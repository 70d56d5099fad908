// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/lasers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

/// The normally distributed noise is clamped to this many standard deviations.
constexpr double kDeviations = 3;

}  // namespace

Lasers::Lasers(const Scenario& scenario, Time begin, std::uint64_t seed)
    : spec_(*scenario.laser),
      robot_radius_m_(scenario.radius_m),
      scanner_(scenario.laser->settings),
      obstacles_(scenario.obstacles),
      map_(scenario.map),
      interval_(from_seconds(1 / scenario.laser->rate_hz / static_cast<double>(scenario.robots.size()))),
      robot_count_(scenario.robots.size()),
      next_scan_(begin + interval_),
      rng_(seed) {}

bool Lasers::scan(World& world, msg::LaserScan& scan) {
  const std::size_t robot = next_robot_;
  next_robot_ = (next_robot_ + 1) % robot_count_;
  next_scan_ = std::max(next_scan_ + interval_, world.time());
  const Body& body = world.bodies()[robot];
  if (!body.is_on_floor() || !world.may_report(robot)) return false;
  discs_.assign(world.opponents().discs().begin(), world.opponents().discs().end());
  for (std::size_t other = 0; other < robot_count_; ++other) {
    const Body& seen = world.bodies()[other];
    if (other != robot && seen.is_on_floor()) discs_.push_back({seen.position_m(), robot_radius_m_});
  }
  const RayScene scene{map_ ? &map_->cells() : nullptr, map_ ? &map_->field() : nullptr, &obstacles_, discs_};
  scan.ranges_m().resize(static_cast<std::size_t>(spec_.settings.beams));
  scanner_.scan(scene, body.position_m(), body.heading_rad(), scan.ranges_m());
  add_noise(scan.ranges_m());

  const Firmware& firmware = world.firmware(robot);
  scan.robot(world.id(robot));
  scan.captured_at_ns(to_ns(world.robot_time(robot, world.time())));
  scan.x_m(firmware.position_m().x());
  scan.y_m(firmware.position_m().y());
  scan.heading_rad(firmware.heading_rad());
  scan.field_of_view_rad(spec_.settings.field_of_view_rad);
  scan.min_range_m(spec_.settings.min_range_m);
  scan.max_range_m(spec_.settings.max_range_m);
  return true;
}

void Lasers::add_noise(std::vector<float>& ranges_m) {
  for (float& range_m : ranges_m) {
    if (rng_.chance(spec_.dropout_probability)) {
      range_m = std::numeric_limits<float>::quiet_NaN();
      continue;
    }
    if (!std::isfinite(range_m)) continue;
    const double noise = std::clamp(rng_.normal() / kDeviations, -1.0, 1.0) * spec_.range_error_m;
    range_m = static_cast<float>(std::max(0.0, static_cast<double>(range_m) + noise));
  }
}

}  // namespace sidestep
