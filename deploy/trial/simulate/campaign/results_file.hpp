// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "common/file/output_file.hpp"
#include "deploy/trial/simulate/campaign/trial_result.hpp"

namespace sidestep {

/// The results of a campaign on disk, one per line, so that an interrupted campaign can resume. The first
/// line identifies the campaign.
class ResultsFile {
 public:
  /// Opens or creates the file. Removes an incomplete last line. Throws std::runtime_error if the file
  /// belongs to another campaign, is malformed, cannot be written, or is being written by another process.
  ResultsFile(const std::string& path, const std::string& campaign);

  /// The results in the file when it was opened.
  const std::vector<TrialResult>& found() const { return found_; }
  /// Writes a result. Throws std::runtime_error if that fails.
  void add(const TrialResult& result);

 private:
  void write(const std::string& line);
  void read(const std::string& campaign);

  std::string path_;
  OutputFile file_;
  std::vector<TrialResult> found_;
};

}  // namespace sidestep
