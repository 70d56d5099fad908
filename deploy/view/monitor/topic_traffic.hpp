// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "common/messaging/topics.hpp"
#include "common/time/histogram.hpp"
#include "deploy/inspect/senders/message_trace.hpp"

namespace sidestep {

/// Rate, losses and delay of each topic, by sender.
class TopicTraffic {
 public:
  /// Adds a message. `channel` distinguishes a topic's channels, which senders number separately.
  void add(const TopicInfo& topic, std::uint64_t channel, const msg::Header& header, std::size_t bytes,
           Time now);

  /// [{"topic":…, "type":…, "hz":…, "kB_per_s":…, "age_s":…, "senders":[{"name":…, "received":…, "lost":…,
  /// "repeated":…, "reordered":…, "delay_p50_ms":…, "delay_p99_ms":…}]}, …]. Rates are since the last call.
  [[nodiscard]] nlohmann::ordered_json take(Time now);

 private:
  struct Stream {
    MessageTrace trace{Duration{0}};
    std::uint64_t not_newest = 0;  // number of repeated or out-of-order messages
    DurationHistogram delays;
  };
  struct Traffic {
    std::string type;
    std::uint64_t messages = 0, bytes = 0;  // since the last call
    Time last{};
    std::map<std::uint32_t, Stream> senders;
  };

  std::map<std::string, Traffic> topics_;
  Time taken_{};
};

}  // namespace sidestep
