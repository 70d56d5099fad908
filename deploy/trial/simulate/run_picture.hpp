// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// Draws the true paths of a run's robots as SVG, animated in real time.
class RunPicture {
 public:
  /// The scenario must outlive the picture.
  explicit RunPicture(const Scenario& scenario) : scenario_(scenario) {}

  void add(const msg::GroundTruth& truth);
  std::string svg() const;

 private:
  struct TrackPoint {
    double at_s;
    Vec2 position_m;
  };
  std::string track(const RobotSpec& robot, const std::vector<TrackPoint>& points) const;
  /// Moves the robot, which is drawn at the last point, along all points from `begin_s` to `end_s`,
  /// repeatedly.
  std::string animation(const std::vector<TrackPoint>& points, double begin_s, double end_s) const;

  const Scenario& scenario_;
  std::map<RobotId, std::vector<TrackPoint>> tracks_;
};

}  // namespace sidestep
