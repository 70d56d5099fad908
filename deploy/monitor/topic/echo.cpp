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
#include "deploy/monitor/topic/listen.hpp"

namespace sidestep {
namespace {

/// The robot's number in "<name>/<robot>" of a topic that every robot has one of, 0 for another topic that is
/// asked for by its name; none when the topic is not the one asked for.
std::optional<std::uint32_t> channel_robot(const TopicInfo& topic, const std::string& asked) {
  if (!topic.per_robot) return asked == topic.name ? std::optional<std::uint32_t>(0) : std::nullopt;
  const std::string prefix = std::string(topic.name) + "/";
  if (!asked.starts_with(prefix)) return std::nullopt;
  const std::string_view digits = std::string_view(asked).substr(prefix.size());
  std::uint32_t robot = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), robot);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  return robot;
}

/// Prints what comes on a channel.
class Echo {
 public:
  Echo(DdsBus& bus, std::uint64_t count) : bus_(bus), count_(count) {}

  /// False when the topic is not the one asked for.
  template <typename Message>
  bool subscribe(const Topic<Message>& topic, const std::string& asked) {
    const std::optional<std::uint32_t> robot = channel_robot(topic, asked);
    if (!robot) return false;
    bus_.subscribe<Message>(topic, *robot, [this](const Message& message) {
      // Strings of ours only, but the dump must not throw whatever comes.
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

int echo_topic(const ListenOptions& options) {
  DdsSettings settings = options.dds;
  settings.participant = "sidestep-topic";
  DdsBus bus(settings);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  Echo echo(bus, options.count);
  const std::string& asked = options.topic;
  const bool is_known =
      echo.subscribe(topics::kImages, asked) || echo.subscribe(topics::kDetections, asked) ||
      echo.subscribe(topics::kWorld, asked) || echo.subscribe(topics::kCommand, asked) ||
      echo.subscribe(topics::kFeedback, asked) || echo.subscribe(topics::kRegistration, asked) ||
      echo.subscribe(topics::kProposal, asked) || echo.subscribe(topics::kVerdict, asked) ||
      echo.subscribe(topics::kLedger, asked) || echo.subscribe(topics::kCoordinator, asked) ||
      echo.subscribe(topics::kStatus, asked) || echo.subscribe(topics::kTruth, asked) ||
      echo.subscribe(topics::kDisturbance, asked) || echo.subscribe(topics::kNetworkFault, asked);
  if (!is_known) {
    fmt::print(stderr, "'{}' is none of our topics: {}\n", asked, known_topics());
    return kExitFailure;
  }
  bus.run();
  return 0;
}

}  // namespace sidestep
