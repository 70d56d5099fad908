// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

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

/// The sum of a column over the rows, of which there is at least one, that have this value in that other
/// column.
double sum_of(const std::vector<StudyRow>& rows, const std::string& column, const std::string& where,
              const std::string& is);
