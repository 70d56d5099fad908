// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {

Conformity unless_busy(bool is_passed, const RobotProbe& probe, std::string& figures) {
  if (is_passed) return Conformity::kPassed;
  const auto reason = probe.why_busy();
  if (!reason) return Conformity::kFailed;
  figures += "; a computer or the network is too busy: " + *reason;
  return Conformity::kNotJudged;
}

std::vector<std::unique_ptr<ConformanceStep>> conformance_steps(const Scenario& scenario,
                                                                const ConformanceSettings& settings) {
  std::vector<std::unique_ptr<ConformanceStep>> steps;
  steps.push_back(make_reports_step());
  steps.push_back(make_clock_step());
  steps.push_back(make_new_agent_step());
  steps.push_back(make_fence_step());
  steps.push_back(make_switch_step());
  steps.push_back(make_versions_step());
  steps.push_back(make_rest_step());
  steps.push_back(make_first_drive_step());
  steps.push_back(make_latency_step());
  steps.push_back(make_tracking_step(scenario));
  steps.push_back(make_turning_step(scenario));
  steps.push_back(make_lost_commands_step(scenario));
  steps.push_back(make_braking_step(scenario));
  steps.push_back(make_takeover_step());
  steps.push_back(make_own_stop_step());
  if (settings.stop_driver) steps.push_back(make_silence_step(scenario));
  return steps;
}

}  // namespace sidestep
