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

std::vector<ConformanceStepMaker> conformance_steps(const Scenario& scenario,
                                                    const ConformanceSettings& settings) {
  const auto on_floor = [&scenario](std::unique_ptr<ConformanceStep> (*make)(const Scenario&)) {
    return [&scenario, make] { return make(scenario); };
  };
  std::vector<ConformanceStepMaker> steps{
      make_reports_step,
      make_clock_step,
      make_new_agent_step,
      make_fence_step,
      make_switch_step,
      make_versions_step,
      make_rest_step,
      make_first_drive_step,
      make_latency_step,
      on_floor(make_tracking_step),
      on_floor(make_turning_step),
      on_floor(make_lost_commands_step),
      on_floor(make_braking_step),
      make_takeover_step,
      make_own_stop_step,
  };
  if (settings.stop_driver) steps.emplace_back(on_floor(make_silence_step));
  return steps;
}

}  // namespace sidestep
