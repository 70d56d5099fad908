// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/log_notices.hpp"

#include <algorithm>
#include <array>
#include <sstream>

namespace sidestep {
namespace {

/// What every process logs at its start begins so.
constexpr std::array<std::string_view, 2> kStartTexts{"Fast DDS ", "safety budget: "};

}  // namespace

std::optional<std::string> notice_of(std::string_view line, LogLevel min_level) {
  // "vision: 2026-11-29 06:00:00.123 warning sidestep-vision: camera 1 is lost"
  std::istringstream words{std::string(line)};
  std::string process, date, time, level, program, text;
  words >> process >> date >> time >> level >> program;
  std::getline(words >> std::ws, text);
  const auto severity = log_level_from(level);
  if (!severity || *severity < min_level || text.empty() || !process.ends_with(':') ||
      !program.ends_with(':'))
    return std::nullopt;
  const auto begins_text = [&](std::string_view start) { return text.starts_with(start); };
  if (*severity < LogLevel::kWarning && std::ranges::any_of(kStartTexts, begins_text)) return std::nullopt;
  return process + " " + text;
}

std::vector<std::string> LogNotices::next() {
  std::vector<std::string> notices;
  for (std::string line; std::getline(file_, line);) {
    partial_ += line;
    if (file_.eof()) break;
    const LogLevel min_level = partial_.starts_with("vision: ") ? kVisionLevel : kOtherLevel;
    const auto notice = notice_of(partial_, min_level);
    partial_.clear();
    if (!notice || shown_ > kMaxLines) continue;
    notices.push_back(++shown_ > kMaxLines ? "further lines of the processes are not shown" : *notice);
  }
  file_.clear();
  return notices;
}

}  // namespace sidestep
