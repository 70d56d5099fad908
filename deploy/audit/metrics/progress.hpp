// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "common/log/log_level.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/audit/metrics/run_metrics.hpp"

namespace sidestep {

/// One line that summarises the whole run.
std::string progress_line(const RunMetrics& metrics, Time now);
/// What the progress line says, distributed over lines of the screen's width, followed by one line per robot.
/// A narrow screen shows fewer columns, a low one fewer robots.
std::string progress_table(const RunMetrics& metrics, Time now, const ScreenSize& screen,
                           bool has_colours = false);

/// The summary of a report with its last line, the verdict, in the verdict's colour.
std::string with_coloured_verdict(const std::string& summary, AuditVerdict verdict);

/// Shows the progress of a run: in a terminal, a table that is redrawn in place; elsewhere, one line per
/// second.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(std::FILE* stream = stdout);
  /// Prints a permanent line above the table.
  void print(const std::string& line, LogLevel level = LogLevel::kInfo);
  /// Refreshes the display if its period has passed.
  void update(const RunMetrics& metrics, Time now);

 private:
  std::FILE* stream_;
  Terminal terminal_;
  RedrawnText table_;
  Time next_{};
};

}  // namespace sidestep
