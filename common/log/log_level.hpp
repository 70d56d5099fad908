// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace sidestep {

/// Severity of a log line, in ascending order. The level of a log is the lowest severity that it writes; kOff
/// disables the log and is not a severity.
enum class LogLevel : std::uint8_t { kTrace, kDebug, kInfo, kWarning, kError, kOff };

/// The names of the levels on the command line and in the log, indexed by LogLevel.
inline constexpr std::array<std::string_view, 6> kLogLevelNames{"trace",   "debug", "info",
                                                                "warning", "error", "off"};

constexpr std::string_view to_text(LogLevel level) { return kLogLevelNames[static_cast<std::size_t>(level)]; }

/// nullopt if no level has this name.
constexpr std::optional<LogLevel> log_level_from(std::string_view name) {
  const auto found = std::ranges::find(kLogLevelNames, name);
  if (found == kLogLevelNames.end()) return std::nullopt;
  return static_cast<LogLevel>(found - kLogLevelNames.begin());
}

}  // namespace sidestep
