// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Samples the times of faults. Faults cluster in time, because simultaneous faults have effects that single
/// faults do not have.
class FaultTimes {
 public:
  /// No fault occurs after `healed_at`.
  FaultTimes(Duration healed_at, Rng& rng);

  Duration healed_at() const { return healed_at_; }
  /// A time at least a millisecond before the end of all faults, often near the time of another fault.
  Duration sample(Rng& rng) const;
  /// `desired_s`, limited to the time from `at` to the end of all faults.
  Duration until_healed(Duration at, double desired_s) const;
  /// The time `desired_s` after `at`, but at the latest just before the end of all faults.
  Duration after(Duration at, double desired_s) const;

 private:
  Duration healed_at_;
  std::vector<double> burst_times_s_;
};

/// Samples a number whose logarithm is uniformly distributed.
double sample_log_uniform(double low, double high, Rng& rng);

}  // namespace sidestep
