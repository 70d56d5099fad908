// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

#include "deploy/evaluation/study/plots.hpp"

namespace sidestep {

struct StudyOptions {
  std::string folder;
  std::uint64_t seed = 1;
  int jobs = 2;           ///< processes at work, where nothing is timed
  bool is_quick = false;  ///< little of everything, for a glance and for tests
};

/// What one experiment measured, and how it is drawn.
struct StudyTable {
  std::string name{};                            ///< of its files
  std::vector<std::string> columns{};            ///< those that depend on the machine end in _us or _ns
  std::vector<std::vector<std::string>> rows{};  ///< a cell for each column
  std::vector<Plot> plots{};                     ///< side by side in one picture
};

/// Values as the cells of a row.
template <typename... Values>
std::vector<std::string> cells(const Values&... values) {
  return {fmt::format("{}", values)...};
}

/// Is told how far an experiment is.
using StudyAdvance = std::function<void(std::size_t done, std::size_t of)>;

/// Shows on stderr how far an experiment is: a line that is redrawn in a terminal, a line in five seconds
/// elsewhere.
class StudyProgress {
 public:
  explicit StudyProgress(std::string name) : name_(std::move(name)) {}
  void operator()(std::size_t done, std::size_t of);

 private:
  std::string name_;
  std::chrono::steady_clock::time_point next_{};
};

/// Makes the folder, and throws std::runtime_error when no file can be written there or when plots cannot be
/// drawn: before anything takes its time.
void require_study_output(const StudyOptions& options);

/// Writes the table as .csv, with the command and the commit in its head, and its picture as .png into the
/// folder, and prints which. `study`: the name of the command. Throws std::runtime_error saying what fails.
void write_study_table(const StudyTable& table, const std::string& study, const StudyOptions& options);

/// The table with aligned columns, as Markdown.
std::string markdown_of(const StudyTable& table);

}  // namespace sidestep
