// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/event_log.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "deploy/view/monitor/unix_time.hpp"

namespace sidestep {

nlohmann::ordered_json to_json(const MonitorEvent& event) {
  constexpr std::array kNames{"info", "warning", "error"};
  return {{"number", event.number},
          {"at_s", unix_seconds(event.at)},
          {"severity", kNames[static_cast<std::size_t>(event.severity)]},
          {"kind", event.kind},
          {"text", event.text},
          {"robots", event.robots}};
}

void EventLog::add(MonitorEvent event) {
  event.number = ++count_;
  events_.push_back(std::move(event));
  if (events_.size() > kMaxEvents) events_.pop_front();
  if (callback_) callback_(events_.back());
}

std::vector<MonitorEvent> EventLog::since(std::uint64_t number) const {
  std::vector<MonitorEvent> result;
  for (const MonitorEvent& event : events_)
    if (event.number > number) result.push_back(event);
  return result;
}

}  // namespace sidestep
