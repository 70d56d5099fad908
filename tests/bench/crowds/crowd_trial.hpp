// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "tests/bench/crowds/crowd_result.hpp"

namespace sidestep {

/// Drives the robots of a scene by Sidestep: the whole system in virtual time, until all robots have arrived
/// or until the scenario's time limit. The report contains the audit's findings, and the paths for a picture.
[[nodiscard]] Report drive_crowd(const Scenario& scenario, std::uint64_t seed);

/// The result in a report. A run of which the audit did not hear enough counts as a violation. The time per
/// cycle is that of the agent's planning by the wall clock; cycles of more than 30 ms, which other processes
/// have interrupted, do not count.
[[nodiscard]] CrowdResult crowd_result_of(const Report& report);

}  // namespace sidestep
