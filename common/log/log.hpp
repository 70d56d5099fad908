// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/log/log_event.hpp"
#include "common/log/log_level.hpp"

namespace sidestep {

/// Sets the level and the process name of the log. From then on log() writes lines of at least this level to
/// stderr, each with the time, the level and the name. Until then the level is info and the name is
/// "sidestep". Call this before other threads log.
void set_up_log(const std::string& process, LogLevel level);

/// Whether log() would write lines of this level.
[[nodiscard]] bool is_logged(LogLevel level);

/// Writes one line to this process's log. Thread-safe. Writing may block, so it must not be called in every
/// control cycle.
void log(LogLevel level, const std::string& text);

/// A line as log() would write it for a process with this name, without the line break.
[[nodiscard]] std::string log_line(const std::string& process, LogLevel level, const std::string& text);

/// Writes the events of a node to the log.
template <typename Node>
void log_events_of(Node& node) {
  LogLevel level = LogLevel::kTrace;
  while (level < LogLevel::kOff && !is_logged(level))
    level = static_cast<LogLevel>(static_cast<int>(level) + 1);
  node.on_event(level, [](const LogEvent& event) { log(event.level, event.text); });
}

}  // namespace sidestep
