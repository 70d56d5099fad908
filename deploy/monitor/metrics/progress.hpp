// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/monitor/metrics/run_metrics.hpp"

namespace sidestep {

/// One line about the whole run.
std::string progress_line(const RunMetrics& judge, Time now);
/// That line, and a line for each robot, at most `max_rows` of them.
std::string progress_table(const RunMetrics& judge, Time now, int max_rows);

/// Shows a run while it lasts: a table that is redrawn in a terminal, plain lines, one a second, elsewhere.
class ProgressDisplay {
 public:
  ProgressDisplay();
  /// Prints a line that stays.
  void say(const std::string& line);
  /// Shows where the run stands, when it is time for it again.
  void update(const RunMetrics& judge, Time now);

 private:
  void erase_table();

  bool is_terminal_;
  int drawn_lines_ = 0;
  Time next_{};
};

}  // namespace sidestep
