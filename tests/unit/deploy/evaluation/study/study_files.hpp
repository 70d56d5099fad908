// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "deploy/evaluation/study/study_table.hpp"

/// Cells by the names of their columns.
using StudyRow = std::map<std::string, std::string>;

/// A folder for a study's files, which goes with this.
class StudyFolder {
 public:
  StudyFolder();
  ~StudyFolder();
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  std::string path() const { return path_.string(); }
  /// The rows of a study's table; checks the lines of its head.
  std::vector<StudyRow> table(const std::string& study, const std::string& name, std::uint64_t seed) const;
  bool has_png(const std::string& name) const;

 private:
  std::filesystem::path path_;
};

std::vector<StudyRow> rows_of(const sidestep::StudyTable& table);
/// Without what depends on the machine.
std::vector<StudyRow> without_times(std::vector<StudyRow> rows);
/// A cell of the only row that has these others.
double number_in(const std::vector<StudyRow>& rows, const StudyRow& cells, const std::string& column);

/// An experiment, asked for a table by a seed.
using Experiment = std::function<sidestep::StudyTable(std::uint64_t seed, const sidestep::StudyAdvance&)>;

/// Checks what holds for any of them: a cell for each column and lines with points; it says how far it is up
/// to the end; the same seed gives the same but for times, another one another.
void check_experiment(const Experiment& experiment);

/// The sum of a column over the rows, of which there is at least one, that have this value in that other
/// column.
double sum_of(const std::vector<StudyRow>& rows, const std::string& column, const std::string& where,
              const std::string& is);
