// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agents/agent/neighbours.hpp"
#include "agents/perception/laser_sight.hpp"
#include "agents/safety/hidden_space.hpp"
#include "common/config/scenario.hpp"

namespace sidestep {

/// The agent's knowledge from its robot's laser. Inputs: scans, and the versions of nearby robots, which
/// explain part of what the laser sees. Outputs: the interpreted scan, and the floor that the laser did not
/// see.
class RobotLaser {
 public:
  /// `rules` must outlive this object. Precondition: the robots of the scenario have lasers.
  RobotLaser(const FloorSpec& floor, const FloorRules& rules);

  /// Processes a scan. Drops and counts it if its time is in the future. `now` is an upper bound of the time
  /// by the robot's clock. If the last scan is in the future, the clock has been set back since: everything
  /// that it and earlier scans showed is forgotten.
  void on_scan(const LaserScan& scan, Neighbours& neighbours, Time now);

  const LaserSight& sight() const { return sight_; }
  /// The other robots at the time of the last scan.
  std::span<const Circle> robots() const { return robots_; }
  /// The floor that the laser did not see in its last scan.
  HiddenSpace hidden_space() const;
  /// The distance that a person can walk before the robot reacts to the scan after the next one. `reaction`
  /// is the time from a scan to the robot's motion.
  double approach_m(Duration reaction) const {
    return max_person_speed_mps_ * to_seconds(2 * scan_period_ + reaction);
  }
  /// Number of scans with times in the future.
  std::uint64_t invalid() const { return invalid_; }

 private:
  const FloorRules& rules_;
  LaserSight sight_;
  Duration max_clock_difference_;
  double max_person_speed_mps_;
  Duration scan_period_;
  std::vector<Circle> robots_;
  std::uint64_t invalid_ = 0;
};

}  // namespace sidestep
