// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/log/log_level.hpp"

namespace sidestep {

/// An event that a node reports to its log.
struct LogEvent {
  LogLevel level = LogLevel::kInfo;
  std::optional<std::uint32_t> robot;  ///< the robot that the event concerns; nullopt if none
  std::string text;
};

using OnLogEvent = std::function<void(const LogEvent&)>;

/// Passes a node's events to its listener. Without a listener, and for events below the listener's level, it
/// formats and allocates nothing.
class EventReporter {
 public:
  /// From now on, passes all events of at least this level to `listener`.
  void set_listener(LogLevel min_level, OnLogEvent listener) {
    min_level_ = min_level;
    listener_ = std::move(listener);
  }

  bool is_wanted(LogLevel level) const { return listener_ && level >= min_level_; }

  template <typename... Arguments>
  void report(LogLevel level, std::optional<std::uint32_t> robot, fmt::format_string<Arguments...> text,
              Arguments&&... arguments) const {
    if (is_wanted(level)) listener_({level, robot, fmt::format(text, std::forward<Arguments>(arguments)...)});
  }

 private:
  LogLevel min_level_ = LogLevel::kOff;
  OnLogEvent listener_;
};

}  // namespace sidestep
