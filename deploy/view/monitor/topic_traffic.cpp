// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor/topic_traffic.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/protocol/process_names.hpp"

namespace sidestep {

void TopicTraffic::add(const TopicInfo& topic, std::uint64_t channel, const msg::Header& header,
                       std::size_t bytes, Time now) {
  constexpr std::size_t kMaxSenders = 4096;
  Traffic& traffic = topics_[topic.name];
  if (traffic.type.empty()) traffic.type = topic.type.name;
  ++traffic.messages;
  traffic.bytes += bytes;
  traffic.last = now;
  if (!traffic.senders.contains(header.sender()) && traffic.senders.size() >= kMaxSenders) return;
  Stream& stream = traffic.senders[header.sender()];
  if (!stream.trace.record(channel, header, now).is_newest) ++stream.not_newest;
  const double delay_s = (static_cast<double>(to_ns(now)) - static_cast<double>(header.stamp_ns())) * 1e-9;
  stream.delays.add(from_seconds(std::clamp(delay_s, 0.0, 1e6)));
}

nlohmann::ordered_json TopicTraffic::take(Time now) {
  const double span_s = std::max(to_seconds(now - taken_), 1e-3);
  taken_ = now;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (auto& [name, traffic] : topics_) {
    nlohmann::ordered_json senders = nlohmann::ordered_json::array();
    for (const auto& [id, stream] : traffic.senders) {
      const std::uint64_t repeated = stream.trace.received() - stream.trace.distinct();
      senders.push_back({{"name", process_name(id)},
                         {"received", stream.trace.received()},
                         {"lost", stream.trace.missed()},
                         {"repeated", repeated},
                         {"reordered", stream.not_newest - std::min(repeated, stream.not_newest)},
                         {"delay_p50_ms", to_seconds(stream.delays.quantile(0.5)) * 1e3},
                         {"delay_p99_ms", to_seconds(stream.delays.quantile(0.99)) * 1e3}});
    }
    rows.push_back({{"topic", name},
                    {"type", traffic.type},
                    {"hz", static_cast<double>(traffic.messages) / span_s},
                    {"kB_per_s", static_cast<double>(traffic.bytes) * 1e-3 / span_s},
                    {"age_s", to_seconds(now - traffic.last)},
                    {"senders", senders}});
    traffic.messages = traffic.bytes = 0;
  }
  return rows;
}

}  // namespace sidestep
