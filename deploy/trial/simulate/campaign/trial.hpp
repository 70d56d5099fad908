// SPDX-License-Identifier: Apache-2.0
#pragma once

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

/// One run of a campaign: a scenario, the faults that happen in it, and its duration.
struct Trial {
  std::uint64_t seed = 1;
  Scenario scenario;
  FaultPlan plan;
  Duration duration{0};
  std::optional<Duration> base_latency = std::nullopt;  ///< set if robots are driven bases; see SimSystem

  std::set<std::string> fault_kinds() const;
  /// A description in one line, without the faults.
  std::string summary() const;
};

/// Samples everything that the seed determines. If no scenario is given, samples the scene. If `has_faults`
/// is false, samples no faults.
[[nodiscard]] Trial sample_trial(std::uint64_t seed, Duration duration,
                                 const std::optional<Scenario>& scenario, bool has_faults = true);

/// Adds failures to a trial's result, whose figures are already set. `progress` and `has_arrived` (of all
/// robots) describe the end of the trial.
void add_failures(const Trial& trial, const std::vector<RobotProgress>& progress, bool has_arrived,
                  const Report& report, TrialResult& result);

/// Callbacks for a closer look at one trial; each may be empty.
struct TrialHooks {
  std::function<void(SimSystem&)> on_start;
  std::function<void(const msg::GroundTruth&)> on_truth;
  std::function<void()> on_end;
};

/// Runs a trial. Fills `report` if it is not null.
TrialResult run_trial(const Trial& trial, Report* report = nullptr, const TrialHooks& hooks = {});

}  // namespace sidestep
