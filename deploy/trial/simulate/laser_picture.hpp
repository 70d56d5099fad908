// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "agents/agent/laser_scan_decoder.hpp"
#include "agents/perception/laser_sight.hpp"
#include "common/config/scenario.hpp"
#include "common/svg/floor_sheet.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Draws as SVG how a robot interprets its laser scans: the last scan, its local grid, where people may step
/// out of hidden space, and which people move.
class LaserPicture {
 public:
  /// The scenario must outlive the picture. Throws std::invalid_argument if it has no laser or no such robot.
  LaserPicture(const Scenario& scenario, RobotId robot);

  /// Adds the robots' positions, for the picture and to recognise hits on robots.
  void add(const msg::GroundTruth& truth);
  void add(const msg::LaserScan& scan);
  std::string svg() const;

 private:
  std::string svg_grid() const;
  std::string svg_scan() const;
  std::string svg_people() const;
  std::string svg_robots() const;

  const Scenario& scenario_;
  RobotId robot_;
  FloorView view_;
  FloorRules rules_;
  LaserScanDecoder decoder_;
  LaserSight sight_;
  std::map<RobotId, Vec2> robots_m_;
};

}  // namespace sidestep
