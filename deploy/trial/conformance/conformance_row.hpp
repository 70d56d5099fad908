// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/motion/limits.hpp"
#include "common/time/time.hpp"

namespace sidestep {

enum class Conformity { kPassed, kFailed, kNotJudged };

/// The result for one rule that the robot must obey.
struct ConformanceRow {
  std::string rule;  ///< as in coordinator/PROTOCOL.md, "What a robot must do"
  Conformity conformity = Conformity::kNotJudged;
  std::string figures;  ///< the measured figures
};

/// Measured capabilities of the robot, for the scenario file.
struct RobotFigures {
  std::optional<double> tracking_bound_m;
  std::optional<double> clock_bound_s;
  std::optional<Duration> latency;   ///< from a command until the robot moves accordingly
  std::optional<double> turn_radps;  ///< the fastest turn that vision saw, downwards in steps of 0.1
  /// Maximum distance from the stop of its version, if commands end at the speed limit without a stop.
  std::optional<double> silence_m;
  MotionLimits limits;
  bool is_within_limits = false;  ///< the robot braked and moved within its limits
};

struct ConformanceReport {
  std::vector<ConformanceRow> rows;
  RobotFigures figures;

  /// Whether every row passed.
  bool is_conformant() const;
  /// Whether any row failed; the others may not have been judged yet.
  bool has_failed() const;
};

/// When the robot's motors obey.
struct MeasuredLatency {
  Duration lead{0};         ///< the latency that the robot assumes
  Duration late{0};         ///< how much later the motors obey: the best estimate
  Duration uncertainty{0};  ///< maximum error of `late`, with a probability of about 95 %
  double speed_mps = 0;     ///< the speed limit
};

/// The row "latency". It passes if the robot's error from a change of velocity by the speed limit is at most
/// `max_error_m`. If the motors seem to obey before the command, vision's dates are wrong, and nothing is
/// judged or printed.
ConformanceRow latency_row(const MeasuredLatency& measured, double max_error_m);

/// The row as one line of text.
std::string to_line(const ConformanceRow& row);
/// The lines to put into the scenario file, if every row passed; otherwise the rows that did not.
std::string scenario_lines(const ConformanceReport& report);
/// The complete result as text.
std::string to_text(const ConformanceReport& report);

}  // namespace sidestep
