// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/audit/metrics/run_metrics.hpp"

namespace sidestep {

/// One line that summarises the whole run.
std::string progress_line(const RunMetrics& metrics, Time now);
/// The progress line, followed by one line per robot, at most `max_rows`.
std::string progress_table(const RunMetrics& metrics, Time now, int max_rows);

/// Shows the progress of a run on stdout: in a terminal, a table that is redrawn in place; elsewhere, one
/// line per second.
class ProgressDisplay {
 public:
  ProgressDisplay();
  /// Prints a permanent line above the table.
  void print(const std::string& line);
  /// Refreshes the display if its period has passed.
  void update(const RunMetrics& metrics, Time now);

 private:
  void erase_table();

  bool is_terminal_;
  int drawn_lines_ = 0;
  Time next_{};
};

}  // namespace sidestep
