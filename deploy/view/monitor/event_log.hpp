// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

enum class Severity : std::uint8_t { kInfo, kWarning, kError };

/// Something that happened in a run.
struct MonitorEvent {
  std::uint64_t number = 0;  ///< counted from 1
  Time at{};
  Severity severity = Severity::kInfo;
  std::string kind;  ///< for example "contact"
  std::string text;  ///< one sentence
  std::vector<RobotId> robots{};
};

/// {"number":…, "at_s":…, "severity":"info", "kind":…, "text":…, "robots":[…]}
[[nodiscard]] nlohmann::ordered_json to_json(const MonitorEvent& event);

/// The latest events of a run.
class EventLog {
 public:
  static constexpr std::size_t kMaxEvents = 10'000;

  /// Adds the event and numbers it.
  void add(MonitorEvent event);
  void on_event(std::function<void(const MonitorEvent&)> callback) { callback_ = std::move(callback); }
  /// The events with higher numbers than `number` that are still remembered.
  std::vector<MonitorEvent> since(std::uint64_t number) const;
  std::uint64_t count() const { return count_; }

 private:
  std::deque<MonitorEvent> events_;
  std::uint64_t count_ = 0;
  std::function<void(const MonitorEvent&)> callback_;
};

}  // namespace sidestep
