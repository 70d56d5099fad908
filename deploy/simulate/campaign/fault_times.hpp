// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/random/rng.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Samples the times of faults. Faults cluster in time, because simultaneous faults have effects that single
/// ones do not have.
class FaultTimes {
 public:
  /// No fault occurs after `healed_at`.
  FaultTimes(Duration healed_at, Rng& rng);

  Duration healed_at() const { return healed_at_; }
  /// A time at least a millisecond before the end of all faults, often near those of other faults.
  Duration sample(Rng& rng) const;
  /// The duration, or the time from `at` to the end of all faults if that is less.
  Duration until_healed(Duration at, double desired_s) const;
  /// This long after `at`, or just before the end of all faults if that is earlier.
  Duration after(Duration at, double desired_s) const;

 private:
  Duration healed_at_;
  std::vector<double> burst_times_s_;
};

/// Uniformly distributed logarithm.
double sample_log_uniform(double low, double high, Rng& rng);

}  // namespace sidestep
