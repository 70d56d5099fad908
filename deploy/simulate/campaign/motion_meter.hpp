// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "idl/monitor.h"

namespace sidestep {

/// How far robots really went, in all and since a time.
class MotionMeter {
 public:
  explicit MotionMeter(Time since) : since_(since) {}

  void add(const msg::GroundTruth& truth);

  double total_m() const;
  double total_since_m() const;
  /// Robots that went less than this since then.
  std::vector<RobotId> still(double less_m) const;

 private:
  struct Way {
    Vec2 last_m{0, 0};
    double total_m = 0, since_m = 0;
  };
  Time since_;
  std::map<RobotId, Way> ways_;
};

}  // namespace sidestep
