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
  std::string details{};            ///< further lines about the misses, each with its end of line
  /// Whether a pause of the machine may be the reason: only then does another run count instead.
  bool may_be_chance = false;
};

/// Prints a line for each run of a measurement at once, and a table at the end.
class FigureTable {
 public:
  /// What counts as missed: each run, or rows of which two runs miss a figure, or one that cannot be chance.
  enum class Rule { kEachRun, kTwoOfThree };

  explicit FigureTable(const std::string& title, Rule rule = Rule::kEachRun);

  /// Whether the row is to be measured again: by the rule of two of three, until two runs agree.
  bool is_open(const std::string& row) const;

  void add(const MeasuredRun& run);
  /// Prints runs and misses of each row, in the order in which rows were added.
  void print() const;
  /// Number of runs that missed a figure, or of rows that failed by the rule of two of three.
  int missed() const;

 private:
  struct Row {
    std::string name;
    int runs = 0, missed = 0;
    bool has_failed = false;  // in a way that cannot be chance
    std::string latest_miss;
  };
  std::string title_;
  Rule rule_;
  std::vector<Row> rows_;
};

/// A whole number of at least 0 in an environment variable, which chooses between the few runs of a test and
/// the many of a measurement.
int runs_from_environment(const char* name, int otherwise);

}  // namespace sidestep
