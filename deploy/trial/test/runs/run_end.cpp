// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/run_end.hpp"

namespace sidestep {

RunEnd run_end(const Report& report, const RunObserver& observer, Time now) {
  RunEnd end;
  const Time zero = observer.begin().value_or(now);
  end.at_s = to_seconds(now - zero);
  end.abort_reason = report.abort_reason;
  end.arrival_s = report.arrival_s;
  for (const auto& [process, differences] : report.mismatches)
    end.mismatches[process] = describe(differences);
  if (!report.audit) {
    end.shortfall = "the run was not audited";
    return end;
  }
  end.violations = report.audit->violations;
  end.shortfall = shortfall(*report.audit);
  if (!report.audit->first.empty()) {
    const Violation& first = report.audit->first.front();
    end.first_violation_at_s = to_seconds(first.detected - zero);
    end.first_violation = to_line(first);
  }
  return end;
}

}  // namespace sidestep
