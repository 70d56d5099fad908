// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "deploy/audit/seen_contacts.hpp"

namespace sidestep {

/// Which messages the auditor receives, and how quickly.
struct AuditInput {
  /// Whether it receives every message from the start on, at the moment it is sent. Only then is a missing
  /// message evidence.
  bool is_complete = false;
  /// Upper bound of the minimum latency from any sender to the auditor. Unused if is_complete. A receiver
  /// that is overloaded exceeds it, so no violation relies on it.
  Duration min_latency_bound{5'000'000};
};

/// The run that is audited, and what the auditor receives of it.
struct AuditedRun {
  Scenario scenario;
  AuditInput input;

  bool is_complete() const { return input.is_complete; }
  Duration latency_bound() const { return is_complete() ? Duration{0} : input.min_latency_bound; }
  std::int64_t clock_bound_ns() const { return from_seconds(scenario.clock_bound_s).count(); }
  /// How far a robot may appear to be from its version because of errors of vision and clocks.
  double sight_allowance_m() const {
    return position_error_m(scenario.vision) + 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
  }
};

}  // namespace sidestep
