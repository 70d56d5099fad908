// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deploy/trial/conformance/conformance_row.hpp"
#include "deploy/trial/conformance/robot_probe.hpp"
#include "deploy/trial/conformance/version_stream.hpp"

namespace sidestep {

inline Conformity passed_if(bool is_passed) { return is_passed ? Conformity::kPassed : Conformity::kFailed; }
/// Like passed_if(), but if a computer or the network was too busy since the step began, the robot is not
/// blamed: not judged, and the reason is added to `figures`.
Conformity unless_busy(bool is_passed, const RobotProbe& probe, std::string& figures);

/// What only some floors offer, and what the user allows.
struct ConformanceSettings {
  /// Stops the process that drives the robot, as if by SIGSTOP, or lets it go on. Null: the step "silence" is
  /// left out.
  std::function<void(bool is_stopped)> stop_driver = {};
  /// How far beyond the stop of its version the robot may come to rest if commands end at the speed limit.
  double max_silence_m = 0.3;
};

/// State shared by all steps.
struct ConformanceContext {
  const Scenario& scenario;
  const ConformanceSettings& settings;
  RobotProbe& probe;
  VersionStream& stream;
  ConformanceReport& report;
  /// Standard deviation on each axis of observations of the resting robot.
  double vision_noise_m = 0;
  /// Whether the robot's motors respond at a different time than the robot assumes.
  bool is_late = false;
  struct FirstDrive {
    double error_m = 0;  ///< the largest that vision saw
    bool has_own_stop = false;
  } first_drive{};
  std::optional<double> reported_error_m{};  ///< for keep_report(): in the previous report
  Time reported_at{};
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

using ConformanceStepMaker = std::function<std::unique_ptr<ConformanceStep>()>;
/// All steps, in order. The scenario must outlive the result.
std::vector<ConformanceStepMaker> conformance_steps(const Scenario& scenario,
                                                    const ConformanceSettings& settings);

// Creates the individual steps; only for conformance_steps().
std::unique_ptr<ConformanceStep> make_reports_step();
std::unique_ptr<ConformanceStep> make_clock_step();
std::unique_ptr<ConformanceStep> make_new_agent_step();
std::unique_ptr<ConformanceStep> make_fence_step();
std::unique_ptr<ConformanceStep> make_switch_step();
std::unique_ptr<ConformanceStep> make_versions_step();
std::unique_ptr<ConformanceStep> make_takeover_step();
std::unique_ptr<ConformanceStep> make_rest_step();
std::unique_ptr<ConformanceStep> make_first_drive_step();
std::unique_ptr<ConformanceStep> make_latency_step();
std::unique_ptr<ConformanceStep> make_tracking_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_turning_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_lost_commands_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_braking_step(const Scenario& scenario);
std::unique_ptr<ConformanceStep> make_own_stop_step();
std::unique_ptr<ConformanceStep> make_silence_step(const Scenario& scenario);

}  // namespace sidestep
