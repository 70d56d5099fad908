// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "deploy/audit/seen_contacts.hpp"

namespace sidestep {

/// Describes which messages the auditor receives, and how quickly.
struct AuditInput {
  /// Whether the auditor receives every message from the start on, at the moment it is sent. Only then does a
  /// missing message prove anything.
  bool is_complete = false;
  /// Upper bound of the minimum latency from any sender to the auditor. Unused if is_complete. An overloaded
  /// receiver exceeds this bound, so no violation relies on it.
  Duration min_latency_bound{5'000'000};
};

/// The audited run, and a description of the messages that the auditor receives.
struct AuditedRun {
  Scenario scenario;
  AuditInput input;

  bool is_complete() const { return input.is_complete; }
  Duration latency_bound() const { return is_complete() ? Duration{0} : input.min_latency_bound; }
  std::int64_t clock_bound_ns() const { return from_seconds(scenario.clock_bound_s).count(); }
  /// Maximum apparent distance of a robot from its version due to errors of vision and clocks.
  double observation_allowance_m() const {
    return position_error_m(scenario.vision) + 2 * scenario.clock_bound_s * scenario.limits.speed_mps;
  }
};

}  // namespace sidestep
