// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "tests/unit/deploy/monitor/audit/history.hpp"

namespace sidestep {

/// A true history of crossing.yaml, the same at each call.
const History& crossing();

inline constexpr AuditTrace kComplete{true, {}};

std::uint64_t count(const AuditTotals& totals, AuditRule rule);

/// A version that a robot switches to in full motion, and what surrounds that.
struct Switch {
  RobotId robot;
  VersionNumber number, before;
  std::int64_t start_ns;
  msg::Version version;
};
Switch a_switch(History& history);

/// Tampers with a copy of the true history, and hears it.
AuditTotals tampered(const std::function<void(History&)>& tamper);

/// The same, and the rule has to be named.
void require_caught(AuditRule rule, const std::function<void(History&)>& tamper);

}  // namespace sidestep
