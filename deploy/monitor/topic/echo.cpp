// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/monitor/topic/describe.hpp"
#include "deploy/monitor/topic/topic_tools.hpp"

namespace sidestep {
namespace {

/// For a per-robot topic, the robot in the channel name "<name>/<robot>"; for any other topic 0. None if the
/// channel does not belong to the topic.
std::optional<std::uint32_t> channel_robot(const TopicInfo& topic, const std::string& channel) {
  if (!topic.per_robot) return channel == topic.name ? std::optional<std::uint32_t>(0) : std::nullopt;
  const std::string prefix = std::string(topic.name) + "/";
  if (!channel.starts_with(prefix)) return std::nullopt;
  const std::string_view digits = std::string_view(channel).substr(prefix.size());
  std::uint32_t robot = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), robot);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return robot;
}

/// Prints the messages of a channel.
class Echo {
 public:
  Echo(DdsBus& bus, std::uint64_t count) : bus_(bus), count_(count) {}

  /// Returns whether the channel belongs to the topic.
  template <typename Message>
  bool subscribe(const Topic<Message>& topic, const std::string& channel) {
    const std::optional<std::uint32_t> robot = channel_robot(topic, channel);
    if (!robot) return false;
    bus_.subscribe<Message>(topic, *robot, [this](const Message& message) {
      // The dump must not throw on invalid UTF-8.
      fmt::print("{}\n",
                 describe(message).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
      std::fflush(stdout);
      if (++printed_ == count_) bus_.stop();
    });
    return true;
  }

 private:
  DdsBus& bus_;
  std::uint64_t count_;
  std::uint64_t printed_ = 0;
};

std::string known_topics() {
  std::string result;
  for (const TopicInfo& topic : all_topics()) {
    result += std::string(result.empty() ? "" : " ") + topic.name + (topic.per_robot ? "/ROBOT" : "");
  }
  return result;
}

}  // namespace

int echo_topic(const TopicOptions& options) {
  DdsSettings settings = options.dds;
  settings.participant = "sidestep-topic";
  DdsBus bus(settings);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  Echo echo(bus, options.count);
  const std::string& channel = options.topic;
  const bool is_known =
      echo.subscribe(topics::kImages, channel) || echo.subscribe(topics::kDetections, channel) ||
      echo.subscribe(topics::kWorld, channel) || echo.subscribe(topics::kObstacles, channel) ||
      echo.subscribe(topics::kCommand, channel) || echo.subscribe(topics::kFeedback, channel) ||
      echo.subscribe(topics::kRegistration, channel) || echo.subscribe(topics::kProposal, channel) ||
      echo.subscribe(topics::kVerdict, channel) || echo.subscribe(topics::kLedger, channel) ||
      echo.subscribe(topics::kCoordinator, channel) || echo.subscribe(topics::kStatus, channel) ||
      echo.subscribe(topics::kTruth, channel) || echo.subscribe(topics::kDisturbance, channel) ||
      echo.subscribe(topics::kNetworkFault, channel) || echo.subscribe(topics::kAttestation, channel) ||
      echo.subscribe(topics::kOrder, channel) || echo.subscribe(topics::kOrderAnswer, channel) ||
      echo.subscribe(topics::kOrderMemory, channel) || echo.subscribe(topics::kOrderStatus, channel) ||
      echo.subscribe(topics::kClockProbe, channel) || echo.subscribe(topics::kClockReading, channel) ||
      echo.subscribe(topics::kRules, channel) || echo.subscribe(topics::kCounters, channel) ||
      echo.subscribe(topics::kScan, channel);
  if (!is_known) {
    fmt::print(stderr, "unknown topic '{}', expected one of: {}\n", channel, known_topics());
    return kExitFailure;
  }
  bus.run();
  return 0;
}

}  // namespace sidestep
