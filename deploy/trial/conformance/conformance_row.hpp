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

/// The row "latency": the motors obey by `late` later than the robot assumes, which is `lead`. If they seem
/// to obey before the command, vision's dates are wrong, and nothing is judged or printed.
ConformanceRow latency_row(Duration lead, Duration late, bool is_allowed);

/// The row as one line of text.
std::string to_line(const ConformanceRow& row);
/// The lines to put into the scenario file.
std::string scenario_lines(const RobotFigures& figures);
/// The complete result as text.
std::string to_text(const ConformanceReport& report);

}  // namespace sidestep
