// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "deploy/trial/conformance/conformance_row.hpp"
#include "deploy/trial/conformance/robot_probe.hpp"
#include "deploy/trial/conformance/version_stream.hpp"

namespace sidestep {

inline Conformity passed_if(bool is_passed) { return is_passed ? Conformity::kPassed : Conformity::kFailed; }

/// State shared by all steps.
struct ConformanceContext {
  const Scenario& scenario;
  RobotProbe& probe;
  VersionStream& stream;
  ConformanceReport& report;
  /// Standard deviation on each axis of observations of the resting robot.
  double vision_noise_m = 0;
  /// Whether the robot's motors respond at a different time than the robot assumes.
  bool is_late = false;
};

/// One step of the test.
class ConformanceStep {
 public:
  virtual ~ConformanceStep() = default;
  /// Called once per cycle before the command is sent, until it returns true; the step has then added its
  /// rows.
  [[nodiscard]] virtual bool update(ConformanceContext& context) = 0;
  /// A few words for the progress line.
  virtual std::string name() const = 0;
  /// Whether the test must end if this step fails.
  virtual bool is_required() const { return false; }
};

/// Creates all steps, in order.
std::vector<std::unique_ptr<ConformanceStep>> conformance_steps(const Scenario& scenario);

// Creates the individual steps; only for conformance_steps().
std::unique_ptr<ConformanceStep> make_reports_step();
std::unique_ptr<ConformanceStep> make_clock_step();
std::unique_ptr<ConformanceStep> make_new_agent_step();
std::unique_ptr<ConformanceStep> make_fence_step();
std::unique_ptr<ConformanceStep> make_switch_step();
std::unique_ptr<ConformanceStep> make_versions_step();
std::unique_ptr<ConformanceStep> make_takeover_step();
std::unique_ptr<ConformanceStep> make_rest_step();
std::unique_ptr<ConformanceStep> make_latency_step();
std::unique_ptr<ConformanceStep> make_tracking_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_lost_commands_step();
std::unique_ptr<ConformanceStep> make_braking_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_own_stop_step();

}  // namespace sidestep
