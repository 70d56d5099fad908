// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/log/log_level.hpp"

namespace sidestep {

/// The process and the text of a line in the log of a ProcessGroup, such as "vision: camera 1 is lost", if
/// its level is at least `min_level`. nullopt for other lines, for what every process says at its start, and
/// for lines of another form.
[[nodiscard]] std::optional<std::string> notice_of(std::string_view line, LogLevel min_level);

/// Reads what the children of a ProcessGroup log, while they run, to show it to the user.
class LogNotices {
 public:
  /// Levels from which on lines of vision and of other processes are shown. Vision's say whom it hears.
  static constexpr LogLevel kVisionLevel = LogLevel::kInfo, kOtherLevel = LogLevel::kWarning;
  /// At most this many lines are shown, because a process may log without end.
  static constexpr int kMaxLines = 50;

  explicit LogNotices(const std::string& path) : file_(path) {}

  /// The notices in complete lines that were written since the last call.
  [[nodiscard]] std::vector<std::string> next();

 private:
  std::ifstream file_;
  std::string partial_;
  int shown_ = 0;
};

}  // namespace sidestep
