// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "deploy/monitor/audit/audit_rules.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// Adds `sidestep audit` and `sidestep record`; parsing one of them sets the action, which returns the exit
/// code.
void add_audit_commands(CLI::App& root, std::function<int()>& action);

/// What an audit found, in a few lines for people.
std::string audit_summary(const AuditTotals& totals);

}  // namespace sidestep
