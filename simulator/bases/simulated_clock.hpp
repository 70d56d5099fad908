// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// How a simulation's time passes. By default it passes evenly, like real time.
struct PaceSettings {
  /// Speeds relative to real time, greater than 0. Each lasts for speed_duration; after the last comes the
  /// first.
  std::vector<double> speeds{1};
  Duration speed_duration = std::chrono::seconds(5);
  Duration step{0};            ///< simulated time advances in such steps; 0: continuously
  Duration max_step_delay{0};  ///< maximum lateness of a step, in simulated time
};

/// The time of a simulation: it may pass faster or slower than real time, and in steps of which each is late
/// by chance.
class SimulatedClock {
 public:
  /// Preconditions: there is a speed, and speeds and speed_duration are positive.
  SimulatedClock(Time begin, const PaceSettings& pace, std::uint64_t seed);

  /// Sets the speed for good. Preconditions: speed > 0, and `now` is not before the times of earlier calls.
  void set_speed(double speed, Time now);
  /// Continues from an earlier simulated time, as if no time had passed since then. Precondition: `now` is
  /// not before the times of earlier calls.
  void resume(Time simulated, Time now);

  /// The simulated time. Precondition: `now` is not before the times of earlier calls.
  Time simulated(Time now);
  /// The real time at which the simulation would reach a simulated time without steps. Exact for the latest
  /// sixteen changes of the speed.
  Time clock(Time simulated) const;

 private:
  /// A period of constant speed, until the next one begins.
  struct Segment {
    Time clock, simulated;  ///< the begin
    double speed;
    Time simulated_at(Time now) const;
  };
  void begin_segment(const Segment& segment);
  void begin_due_speeds(Time now);
  void schedule_step();

  PaceSettings pace_;
  Rng rng_;
  std::vector<Segment> segments_;  ///< at most kMaxSegments, in ascending order
  std::size_t next_speed_ = 1;     ///< not reduced modulo the number of speeds
  Time next_speed_at_;
  Time step_;          ///< simulated time of the latest step
  Time next_step_at_;  ///< simulated time at which the next step begins if time passes continuously
};

}  // namespace sidestep
