// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/trial/conformance/conformance_step.hpp"

namespace sidestep {

/// Tests one robot alone on a floor. It plays the robot's agent, without a coordinator, and compares vision's
/// observations and the robot's reports with what a robot must do (coordinator/PROTOCOL.md). The bus must
/// make no callback after this object's destruction.
class Conformance {
 public:
  /// Precondition: the scenario contains the robot.
  Conformance(Bus& bus, const Scenario& scenario, RobotId robot, Incarnation incarnation,
              ConformanceSettings settings = {});
  Conformance(const Conformance&) = delete;
  Conformance& operator=(const Conformance&) = delete;

  bool is_finished() const { return index_ == steps_.size(); }
  const ConformanceReport& report() const { return report_; }
  /// The current step of the test, in words.
  std::string activity() const;

 private:
  void cycle();
  /// Continues with the next step, or makes this one again if it could not be judged.
  void end_step();

  Bus& bus_;
  const Scenario scenario_;
  const ConformanceSettings settings_;
  RobotProbe probe_;
  VersionStream stream_;
  ConformanceReport report_;
  ConformanceContext context_;
  std::vector<ConformanceStepMaker> steps_;
  std::size_t index_ = 0;  ///< of the current step
  std::unique_ptr<ConformanceStep> step_;
  int attempt_ = 1;
  ConformanceReport before_step_;  ///< without the rows and figures of the current step
  bool was_late_ = false;          ///< ConformanceContext::is_late before the current step
};

}  // namespace sidestep
