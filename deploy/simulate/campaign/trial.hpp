// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "deploy/monitor/metrics/report.hpp"
#include "deploy/simulate/campaign/fault_plan.hpp"
#include "deploy/simulate/system/sim_system.hpp"
#include "idl/monitor.h"

namespace sidestep {

/// One seed of the search: a floor, what goes wrong on it, and for how long.
struct Trial {
  std::uint64_t seed = 1;
  Scenario scenario;
  FaultPlan plan;
  Duration duration{0};
};

/// Draws everything that the seed decides; the floor is the scenario's when there is one.
Trial sample_trial(std::uint64_t seed, Duration duration, const std::optional<Scenario>& scenario);

/// How a trial went. `failures` are in words; none: it passed.
struct TrialResult {
  std::uint64_t seed = 0;
  std::vector<std::string> failures;
  std::uint64_t contacts = 0;
  std::uint64_t contacts_by_hand = 0;  ///< where robots were pushed or slipped, which is beyond the bounds
  std::uint64_t promise_violations = 0, firmware_violations = 0;
  std::uint64_t proposals = 0, grants = 0, denials = 0;
  double robot_s = 0;       ///< robots times simulated time
  double moved_m = 0;       ///< by all robots together
  double calm_moved_m = 0;  ///< that of it which came after everything had healed
  int robots = 0;
  int idle = 0;  ///< robots that did not move after everything had healed
  double min_clearance_m = 1e9;
  double wall_s = 0;
};

/// Runs a trial. The report, every ground truth and the system itself, before it runs and after, are for
/// whoever wants to look at one closely.
TrialResult run_trial(const Trial& trial, Report* report = nullptr,
                      const std::function<void(const msg::GroundTruth&)>& on_truth = {},
                      const std::function<void(SimSystem&)>& before = {},
                      const std::function<void()>& after = {});

}  // namespace sidestep
