// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/fault/plan/run_history.hpp"
#include "deploy/fault/plan/run_observer.hpp"
#include "deploy/monitor/metrics/report.hpp"

namespace sidestep {

/// The end of a run at the time `now`, according to its report.
[[nodiscard]] RunEnd run_end(const Report& report, const RunObserver& observer, Time now);

}  // namespace sidestep
