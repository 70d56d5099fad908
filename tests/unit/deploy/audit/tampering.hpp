// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "tests/unit/deploy/audit/history.hpp"

namespace sidestep {

/// An unmodified history of crossing.yaml, identical for each call.
const MessageHistory& crossing();

inline constexpr AuditInput kComplete{true, {}};

std::uint64_t count(const AuditTotals& totals, AuditRule rule);

/// A version that a moving robot switches to, and the version executed before it.
struct Switch {
  RobotId robot;
  VersionNumber number, before;
  std::int64_t start_ns;
  msg::Version version;
};
Switch first_moving_switch(MessageHistory& history);

/// The audit of a copy of crossing() after `tamper` has modified it.
AuditTotals audit_tampered_crossing(const std::function<void(MessageHistory&)>& tamper);

/// Fails the test unless the audit of the modified history reports a violation of the rule.
void require_violation(AuditRule rule, const std::function<void(MessageHistory&)>& tamper);

}  // namespace sidestep
