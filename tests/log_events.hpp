// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "common/log/log_event.hpp"

namespace sidestep {

/// Collects the events that nodes report.
class LogEvents {
 public:
  template <typename Node>
  explicit LogEvents(Node& node) {
    node.on_event(LogLevel::kTrace, [this](const LogEvent& event) { events_.push_back(event); });
  }
  LogEvents(const LogEvents&) = delete;
  LogEvents& operator=(const LogEvents&) = delete;

  const std::vector<LogEvent>& all() const { return events_; }
  /// Number of events that contain this text.
  std::ptrdiff_t count(const std::string& text) const {
    return std::ranges::count_if(
        events_, [&](const LogEvent& event) { return event.text.find(text) != std::string::npos; });
  }
  /// The text of all events, one per line, for messages of failing tests.
  std::string text() const {
    std::string result;
    for (const LogEvent& event : events_)
      result += std::string(to_text(event.level)) + " " + event.text + "\n";
    return result;
  }
  void clear() { events_.clear(); }

 private:
  std::vector<LogEvent> events_;
};

}  // namespace sidestep
