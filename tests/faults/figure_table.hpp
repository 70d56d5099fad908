// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// The outcome of one run of a measurement.
struct MeasuredRun {
  std::string row;                  ///< the row of the table to which it belongs
  std::string figures;              ///< what was measured
  std::vector<std::string> misses;  ///< figures that were missed; empty: none
  bool is_unsafe = false;           ///< whether robots touched or the audit found a violation
};

/// Prints a line for each run of a measurement at once, and a table at the end.
class FigureTable {
 public:
  /// What counts as missed: each run, or most of a row's runs.
  enum class Judged { kEachRun, kMajority };

  explicit FigureTable(const std::string& title, Judged judged = Judged::kEachRun);

  /// Whether the row is to be measured again: by majority, three times if the first run misses a figure.
  bool is_open(const std::string& row) const;

  void add(const MeasuredRun& run);
  /// Prints runs and misses of each row, in the order in which rows were added.
  void print() const;
  /// Number of runs that missed a figure; by majority, of rows that missed in more than half of their runs,
  /// or were unsafe in one.
  int missed() const;

 private:
  struct Row {
    std::string name;
    int runs = 0, missed = 0;
    bool is_unsafe = false;
    std::string latest_miss;
  };
  std::string title_;
  Judged judged_;
  std::vector<Row> rows_;
};

/// A whole number of at least 0 in an environment variable, which chooses between the few runs of a test and
/// the many of a measurement.
int runs_from_environment(const char* name, int otherwise);

}  // namespace sidestep
