// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_recovery.hpp"

#include <algorithm>

namespace sidestep {
namespace {

Duration magnitude(Duration d) { return d < Duration{0} ? -d : d; }

}  // namespace

void ClockRecovery::on_message(std::uint32_t reference, std::int64_t stamp_ns, Time now) {
  if (stamp_ns < 0 || stamp_ns > to_ns(kMaxTime)) return;
  if (references_.size() >= kMaxReferences && !references_.contains(reference)) return;
  Reference& known = references_[reference];
  known.min_age = std::min(known.min_age, now - time_from_ns(stamp_ns));
  ++known.messages;
}

bool ClockRecovery::is_host_clock_right(Duration host_ahead) const {
  bool agrees_with_host = false;
  for (const auto& [id, reference] : references_) {
    if (reference.messages < kMinMessages) continue;
    if (is_delay(reference.min_age)) return false;
    agrees_with_host = agrees_with_host || is_delay(reference.min_age + host_ahead);
  }
  return agrees_with_host;
}

bool ClockRecovery::end_period(Duration host_ahead, bool is_in_use) {
  const bool is_stepped = magnitude(host_ahead) >= kMinStep;
  const bool is_same_step = magnitude(host_ahead - last_host_ahead_) < kTolerance;
  const bool counts = is_stepped && !is_in_use && is_host_clock_right(host_ahead);
  evident_periods_ = !counts ? 0 : is_same_step ? evident_periods_ + 1 : 1;
  last_host_ahead_ = host_ahead;
  references_.clear();
  return evident_periods_ >= kPeriods;
}

}  // namespace sidestep
