// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/test/judgement/run_history.hpp"
#include "deploy/trial/test/judgement/run_observer.hpp"

namespace sidestep {

/// The end of a run at the time `now`, according to its report.
[[nodiscard]] RunEnd run_end(const Report& report, const RunObserver& observer, Time now);

}  // namespace sidestep
