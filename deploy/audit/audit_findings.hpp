// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>
#include <functional>
#include <string>
#include <utility>

#include "deploy/audit/audit_totals.hpp"
#include "deploy/audit/audited_robot.hpp"

namespace sidestep {

/// The findings of all checks of an audit. Counts the violations, keeps the first ones, and calls back for
/// each.
struct AuditFindings {
  AuditTotals totals;
  Time now{};  ///< current time by the auditor's clock
  std::function<void(const Violation&)> on_violation;

  void report(Violation violation) {
    violation.detected = now;
    ++totals.violations;
    ++totals.by_rule[static_cast<std::size_t>(violation.rule)];
    if (totals.first.size() < AuditTotals::kMaxKept) totals.first.push_back(violation);
    if (on_violation) on_violation(violation);
  }
  /// Reports a violation. `known`: the version involved, or nullptr. Arguments are formatted into the detail.
  void report(AuditRule rule, RobotId robot, const KnownVersion* known, Epoch epoch, std::string detail) {
    report({rule, {}, robot, {}, known ? known->number : 0, 0, epoch, std::move(detail)});
  }
  template <typename Argument, typename... Arguments>
  void report(AuditRule rule, RobotId robot, const KnownVersion* known, Epoch epoch,
              fmt::format_string<const Argument&, const Arguments&...> detail, const Argument& argument,
              const Arguments&... arguments) {
    report(rule, robot, known, epoch, fmt::format(detail, argument, arguments...));
  }
};

}  // namespace sidestep
