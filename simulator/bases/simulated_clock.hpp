// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// The time of a simulation that runs faster or slower than the real clock.
class SimulatedClock {
 public:
  SimulatedClock(Time begin, double speed) : clock_(begin), simulated_(begin), speed_(speed) {}

  /// Precondition: speed > 0.
  void set_speed(double speed, Time now) {
    simulated_ = simulated(now);
    clock_ = now;
    speed_ = speed;
  }
  Time simulated(Time clock) const { return simulated_ + scaled(clock - clock_, speed_); }
  Time clock(Time simulated) const { return clock_ + scaled(simulated - simulated_, 1 / speed_); }

 private:
  static Duration scaled(Duration duration, double factor) {
    return Duration{static_cast<Duration::rep>(static_cast<double>(duration.count()) * factor)};
  }
  Time clock_, simulated_;
  double speed_;
};

}  // namespace sidestep
