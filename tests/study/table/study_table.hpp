// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

#include "tests/study/table/plots.hpp"

namespace sidestep {

struct StudyOptions {
  std::string folder;
  std::uint64_t seed = 1;
  int jobs = 2;                  ///< number of parallel processes if nothing is timed
  bool is_quick = false;         ///< a small version of every experiment, for tests
  std::uint64_t cases = 10'000;  ///< number of cases in studies of random cases
};

/// The measurements of one experiment, and its plots.
struct StudyTable {
  std::string name{};                            ///< stem of the file names
  std::vector<std::string> columns{};            ///< machine-dependent columns end in _us or _ns
  std::vector<std::vector<std::string>> rows{};  ///< rows with one cell per column
  std::vector<Plot> plots{};                     ///< side by side in one picture
};

/// Converts values to the cells of a row.
template <typename... Values>
std::vector<std::string> cells(const Values&... values) {
  return {fmt::format("{}", values)...};
}

/// Receives the progress of an experiment.
using ProgressCallback = std::function<void(std::size_t done, std::size_t of)>;

/// Shows the progress of an experiment on stderr: in a terminal, a line that is redrawn; elsewhere, a line
/// every five seconds.
class StudyProgress {
 public:
  explicit StudyProgress(std::string name) : name_(std::move(name)) {}
  void operator()(std::size_t done, std::size_t of);

 private:
  std::string name_;
  std::chrono::steady_clock::time_point next_{};
};

/// Creates the folder. Throws std::runtime_error if no file can be written there or plots cannot be drawn, so
/// that a long study does not fail at its end.
void require_study_output(const StudyOptions& options);

/// Writes the table as .csv, with the command and the commit in its head, and its plots, if any, as .png into
/// the folder, and prints their names. `study` is the name of the command. Throws std::runtime_error with the
/// reason if that fails.
void write_study_table(const StudyTable& table, const std::string& study, const StudyOptions& options);

/// The table with aligned columns, as Markdown.
std::string markdown_of(const StudyTable& table);

}  // namespace sidestep
