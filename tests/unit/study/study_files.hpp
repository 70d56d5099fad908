// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/study/table/study_table.hpp"

/// A row of a table: cells by column name.
using StudyRow = std::map<std::string, std::string>;

/// A temporary folder for a study's files.
class StudyFolder {
 public:
  StudyFolder();
  ~StudyFolder();
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  std::string path() const { return path_.string(); }
  /// Reads the rows of a study's table and checks the lines of its header.
  std::vector<StudyRow> table(const std::string& study, const std::string& name, std::uint64_t seed) const;
  bool has_png(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

std::vector<StudyRow> rows_of(const sidestep::StudyTable& table);
/// The rows without machine-dependent columns.
std::vector<StudyRow> without_timings(std::vector<StudyRow> rows);
/// The number in a column of the only row with the given cells.
double number_in(const std::vector<StudyRow>& rows, const StudyRow& cells, const std::string& column);

/// Runs an experiment with a seed.
using Experiment = std::function<sidestep::StudyTable(std::uint64_t seed, const sidestep::ProgressCallback&)>;

/// Checks the properties of every experiment: each row has a cell for each column, each plot has lines with
/// points, progress is reported up to the end, the same seed gives the same rows except for times, and a
/// different seed gives different rows.
void check_experiment(const Experiment& experiment);

/// The sum of a column over the rows with the value `is` in the column `where`. Fails the test if no row has
/// this value.
double sum_of(const std::vector<StudyRow>& rows, const std::string& column, const std::string& where,
              const std::string& is);
