// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>

#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/campaign/fault_kinds.hpp"
#include "deploy/trial/simulate/campaign/fault_plan.hpp"
#include "deploy/trial/simulate/campaign/trial_result.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "idl/monitor.hpp"

namespace sidestep {

/// The end of a trial has no faults for this long, so that the system can recover from them.
inline constexpr Duration kFaultFreeEnd = std::chrono::seconds(12);

/// The shortest trial in which a healthy system cannot fail: its robots have time to start, or to recover
/// from faults, before they must drive. A trial with faults has them for as long again.
constexpr Duration min_trial_duration(bool has_faults) {
  return has_faults ? 2 * kFaultFreeEnd : kFaultFreeEnd;
}

/// One run of a campaign: a scenario, the faults that happen in it, and its duration.
struct Trial {
  std::uint64_t seed = 1;
  Scenario scenario;
  FaultPlan plan;
  Duration duration{0};
  std::optional<DrivenBaseSettings> bases = std::nullopt;  ///< set if robots are driven bases

  std::set<std::string> fault_kinds() const;
  /// A description in one line, without the faults.
  std::string summary() const;
};

/// Samples everything that the seed determines. If no scenario is given, samples the scene. If `has_faults`
/// is false, samples no faults. The faults of a trial shorter than min_trial_duration() end after half of it.
[[nodiscard]] Trial sample_trial(std::uint64_t seed, Duration duration,
                                 const std::optional<Scenario>& scenario, bool has_faults = true);

/// Adds failures to a trial's result, whose figures are already set. `progress` and `has_arrived` (of all
/// robots) describe the end of the trial.
void add_failures(const Trial& trial, const std::vector<RobotProgress>& progress, bool has_arrived,
                  const Report& report, TrialResult& result);

/// Callbacks for a closer look at one trial; each may be empty.
struct TrialHooks {
  std::function<void(SimSystem&)> on_start;
  std::function<void()> on_end;
};

/// Runs a trial. Fills `report` if it is not null.
TrialResult run_trial(const Trial& trial, Report* report = nullptr, const TrialHooks& hooks = {});

}  // namespace sidestep
