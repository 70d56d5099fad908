// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "idl/monitor.h"

namespace sidestep {

/// Draws where the robots of a run really went, as SVG.
class Picture {
 public:
  /// The scenario outlives the picture.
  explicit Picture(const Scenario& scenario) : scenario_(scenario) {}

  void add(const msg::GroundTruth& truth);
  std::string svg() const;

 private:
  struct Sight {
    double at_s;
    Vec2 position_m;
  };
  std::string track(const RobotSpec& robot, const std::vector<Sight>& sights) const;
  std::string end(const RobotSpec& robot, const Vec2& place_m) const;

  const Scenario& scenario_;
  std::map<RobotId, std::vector<Sight>> tracks_;
};

}  // namespace sidestep
