// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/motion/trajectory.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Estimates how late a robot follows its trajectories, from observations of several starts from rest.
class LatencyFit {
 public:
  static constexpr Duration kMaxLate = std::chrono::milliseconds(150);

  struct Result {
    Duration late{0};  ///< the delay with which the trajectories fit the observations best
    /// The true delay is within this of `late`, with a probability of about 95 %.
    Duration uncertainty{0};
  };

  /// Begins the next start; the observations that follow belong to it.
  void begin_start(const Trajectory& trajectory) { starts_.push_back({trajectory, {}}); }
  /// Adds an observation. Precondition: begin_start() was called.
  void add(Time at, const Vec2& seen_m);
  std::size_t observations() const { return observations_; }
  /// Precondition: there is an observation.
  Result result() const;

 private:
  /// The sums of squared errors for all delays that are tried.
  using Errors = std::vector<double>;
  struct Start {
    Trajectory trajectory;
    Errors errors_m2;  ///< empty without observations
  };

  std::vector<Start> starts_;
  std::size_t observations_ = 0;
};

}  // namespace sidestep
