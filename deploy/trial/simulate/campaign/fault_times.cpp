// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/fault_times.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

// A fault begins at least this long before the end of all faults.
constexpr Duration kMinFaultDuration = std::chrono::milliseconds(1);
constexpr double kBurstDeviation_s = 0.4;

}  // namespace

FaultTimes::FaultTimes(Duration healed_at, Rng& rng) : healed_at_(std::max(Duration{0}, healed_at)) {
  for (std::uint64_t left = 1 + rng.below(5); left > 0; --left)
    burst_times_s_.push_back(rng.uniform(0, to_seconds(healed_at_)));
}

Duration FaultTimes::sample(Rng& rng) const {
  double time_s = rng.uniform(0, to_seconds(healed_at_));
  if (!rng.chance(0.35))
    time_s = burst_times_s_[rng.below(burst_times_s_.size())] + kBurstDeviation_s * rng.normal();
  return std::clamp(from_seconds(time_s), Duration{0}, std::max(Duration{0}, healed_at_ - kMinFaultDuration));
}

Duration FaultTimes::until_healed(Duration at, double desired_s) const {
  return std::min(from_seconds(desired_s), healed_at_ - at);
}

Duration FaultTimes::after(Duration at, double desired_s) const {
  return std::min(at + from_seconds(desired_s), healed_at_ - Duration{1});
}

double sample_log_uniform(double low, double high, Rng& rng) {
  return low * std::pow(high / low, rng.uniform());
}

}  // namespace sidestep
