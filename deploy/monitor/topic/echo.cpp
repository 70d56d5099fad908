// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <fmt/core.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/monitor/record/playback_bus.hpp"
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

std::string known_topics() {
  std::string result;
  for (const TopicInfo& topic : all_topics())
    result += std::string(result.empty() ? "" : " ") + topic.name + (topic.per_robot ? "/ROBOT" : "");
  return result;
}

/// Prints the messages of a channel, and calls `stop` when enough are printed. False: it belongs to no topic.
bool print_channel(Bus& bus, const std::string& channel, MessagePrinter& printer,
                   const std::function<void()>& stop) {
  bool is_known = false;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    const std::optional<std::uint32_t> robot = channel_robot(topic, channel);
    if (!robot) return;
    is_known = true;
    bus.subscribe<Message>(topic, *robot, [&printer, stop](const Message& message) {
      printer.add(describe(message));
      if (printer.is_done()) stop();
    });
  });
  if (!is_known) fmt::print(stderr, "unknown topic '{}', expected one of: {}\n", channel, known_topics());
  return is_known;
}

int echo_recording(const TopicOptions& options, MessagePrinter& printer) {
  PlaybackBus bus(options.recording_file);
  if (!print_channel(bus, options.topic, printer, [&bus] { bus.stop(); })) return kExitFailure;
  const PlaybackResult result = bus.play();
  if (!result.damage.empty())
    fmt::print(stderr, "{}: {}; the messages before that were used\n", options.recording_file, result.damage);
  return printer.printed() > 0 ? 0 : kExitFailure;
}

}  // namespace

int echo_topic(const TopicOptions& options) {
  MessagePrinter printer(options.printer, [](const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  });
  if (!options.recording_file.empty()) return echo_recording(options, printer);
  DdsSettings dds = options.dds;
  dds.participant = "sidestep-topic";
  DdsBus bus(dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  if (!print_channel(bus, options.topic, printer, [&bus] { bus.stop(); })) return kExitFailure;
  bus.run();
  return 0;
}

}  // namespace sidestep
