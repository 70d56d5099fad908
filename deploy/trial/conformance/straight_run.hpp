// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {

/// Drives to the edge of the field and accelerates from there along x.
class StraightRun {
 public:
  enum class Phase { kUnderWay, kFast, kGivenUp };

  /// The speed is at most `speed_mps`, and at most that from which there is room to brake, after `free` at
  /// this speed.
  StraightRun(const Scenario& scenario, double speed_mps, Duration free);

  /// Call once per cycle until it returns another phase than kUnderWay. kFast: the last version of the stream
  /// has the speed, or as much of it as the field allows.
  Phase update(ConformanceContext& context);
  double speed_mps() const { return speed_mps_; }

 private:
  double speed_mps_, end_m_;
  Vec2 begin_m_;
  std::optional<Time> since_;  ///< the beginning of the way to begin_m_, then of the acceleration
  bool has_begun_ = false;
};

}  // namespace sidestep
