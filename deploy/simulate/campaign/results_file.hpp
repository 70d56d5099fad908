// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "deploy/simulate/campaign/trial.hpp"

namespace sidestep {

/// The results of a search on disk, a line each, so that a search that was stopped goes on where it was. The
/// first line says what they are results of.
class ResultsFile {
 public:
  /// Opens the file, or makes it. A line that was not written to its end is dropped. Throws
  /// std::runtime_error when the file is of another search, makes no sense, or cannot be written.
  ResultsFile(const std::string& path, const std::string& of_what);

  /// What the file held when it was opened.
  const std::vector<TrialResult>& found() const { return found_; }
  /// Throws std::runtime_error when it cannot be written.
  void add(const TrialResult& result);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  void write(const std::string& line);
  void read(const std::string& of_what);

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<TrialResult> found_;
};

}  // namespace sidestep
