// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/collision/obstacle_world.hpp"
#include "common/config/scenario.hpp"
#include "common/map/laser_scanner.hpp"
#include "common/random/rng.hpp"
#include "idl/laser.hpp"
#include "simulator/world/world.hpp"

namespace sidestep {

/// The lasers of the robots, each at the centre of its robot. They scan in turn, each once per period, and
/// see obstacles, the map, other robots and people. A scan is taken at one instant. Its pose is the robot's
/// own estimate.
class Lasers {
 public:
  /// Precondition: the scenario has a laser.
  Lasers(const Scenario& scenario, Time begin, std::uint64_t seed);

  /// When the next scan is due, and which robot takes it.
  Time next_scan() const { return next_scan_; }
  std::size_t next_robot() const { return next_robot_; }
  /// Takes that scan. Sets everything but the header. False if the robot is off the floor, or reports
  /// nothing. Precondition: world.time() is that of the scan, up to a step.
  [[nodiscard]] bool scan(World& world, msg::LaserScan& scan);

 private:
  void add_noise(std::vector<float>& ranges_m);

  LaserSpec spec_;
  double robot_radius_m_;
  LaserScanner scanner_;
  ObstacleWorld obstacles_;
  std::shared_ptr<const FloorMap> map_;
  Duration interval_;  // between the scans of two robots
  std::size_t robot_count_;
  Time next_scan_;
  std::size_t next_robot_ = 0;
  Rng rng_;
  std::vector<Circle> discs_;  // of robots and people
};

}  // namespace sidestep
