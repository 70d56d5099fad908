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

  /// The time at which the next scan is due, and the robot that takes it.
  Time next_scan() const { return next_scan_; }
  std::size_t next_robot() const { return next_robot_; }
  /// Takes the next scan. Sets everything except the header. Returns false if the robot is off the floor or
  /// reports nothing. Precondition: world.time() is the time of the scan, within one step.
  [[nodiscard]] bool scan(World& world, msg::LaserScan& scan);

 private:
  void add_noise(std::vector<float>& ranges_m);

  LaserSpec spec_;
  double robot_radius_m_;
  LaserScanner scanner_;
  ObstacleWorld obstacles_;
  std::shared_ptr<const FloorMap> map_;
  Duration interval_;  // interval between consecutive scans, which are of different robots
  std::size_t robot_count_;
  Time next_scan_;
  std::size_t next_robot_ = 0;
  Rng rng_;
  std::vector<Circle> discs_;  // discs of robots and people
};

}  // namespace sidestep
