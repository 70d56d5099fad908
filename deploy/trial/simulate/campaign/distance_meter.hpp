// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// The true distances driven by robots, in total and since a given time.
class DistanceMeter {
 public:
  explicit DistanceMeter(Time since) : since_(since) {}

  void add(const msg::GroundTruth& truth);

  double total_m() const;
  double recent_total_m() const;
  /// Robots that have driven less than `min_distance_m` since the given time.
  std::vector<RobotId> stationary_robots(double min_distance_m) const;

 private:
  struct RobotDistance {
    Vec2 last_m{0, 0};
    double total_m = 0, since_m = 0;
  };
  Time since_;
  std::map<RobotId, RobotDistance> distances_;
};

}  // namespace sidestep
