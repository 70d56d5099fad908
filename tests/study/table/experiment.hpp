// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/study/table/study_table.hpp"

namespace sidestep {

/// One run: the key of its row in the table, and how to measure it.
struct Run {
  std::string line;  ///< the plot line that shows this run; empty: none
  double x = 0;
  std::vector<std::string> key;  ///< cells of the first columns
  /// Returns the other cells, separated by commas, the plotted one first.
  std::function<std::string()> columns;
};

/// Runs that fill one table. Each is measured in its own process.
struct Experiment {
  StudyTable table;
  int jobs = 1;
  std::vector<Run> runs;
};

/// Measures all runs, and fills the table and the lines of its first plot. Shows progress on stderr. Throws
/// std::runtime_error if a run ends abnormally.
void measure(Experiment& experiment);

}  // namespace sidestep
