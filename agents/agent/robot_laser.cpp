// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/robot_laser.hpp"

#include "agents/agent/planning_distances.hpp"
#include "agents/safety/creeping.hpp"
#include "common/time/clock_bounds.hpp"

namespace sidestep {
namespace {

constexpr double kMaxHeadingError_rad = 0.02;  ///< bound of the error of a scan's heading

/// The position of a robot at a time, which may be shortly before its version starts.
Vec2 position_at(const Trajectory& trajectory, Time t) {
  if (t >= trajectory.start()) return trajectory.state_at(t).position_m;
  const State& first = trajectory.at_start();
  return first.position_m - to_seconds(trajectory.start() - t) * first.velocity_mps;
}

}  // namespace

RobotLaser::RobotLaser(const FloorSpec& floor, const FloorRules& rules)
    : rules_(rules),
      sight_(*floor.laser, rules,
             {.position_error_m = floor.tracking_bound_m, .heading_error_rad = kMaxHeadingError_rad}),
      max_clock_difference_(max_clock_difference(floor.clock_bound_s)),
      max_person_speed_mps_(floor.max_opponent_speed_mps),
      scan_period_(from_seconds(1 / floor.laser->rate_hz)) {}

void RobotLaser::on_scan(const LaserScan& scan, Neighbours& neighbours, Time now) {
  if (scan.captured_at > now + max_clock_difference_) {
    ++invalid_;
    return;
  }
  if (sight_.captured_at() > now + max_clock_difference_) sight_.forget();
  robots_.clear();
  for (const Version* version : neighbours.newest(scan.at_m, page_horizon_m(rules_)))
    robots_.push_back({position_at(version->trajectory, scan.captured_at), rules_.radius_m});
  sight_.update(scan, robots_);
}

HiddenSpace RobotLaser::hidden_space() const {
  const Visibility& visibility = sight_.visibility();
  HiddenSpace hidden{visibility.frontiers(), visibility.closed_gaps(), sight_.captured_at(),
                     max_person_speed_mps_};
  hidden.heading_error_rad = kMaxHeadingError_rad;
  hidden.creep_mps = kCreep_mps;
  hidden.observed_from_m = sight_.beams().at_m();
  return hidden;
}

}  // namespace sidestep
