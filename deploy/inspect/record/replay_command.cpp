// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/replay_command.hpp"

#include <algorithm>
#include <atomic>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/messaging/dds/listener.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/record/replay.hpp"

namespace sidestep {
namespace {

constexpr const char* kParticipant = "sidestep-replay";
constexpr Duration kDiscovery{1'500'000'000};  // participants announce themselves once a second
/// How long writers outlive the last message: when a writer disappears, readers drop those of its messages
/// that they have not taken yet.
constexpr Duration kWriterLinger{300'000'000};
constexpr Duration kCheckPeriod{1'000'000'000};

struct ReplayOptions {
  std::string file;
  std::vector<std::string> topics;
  double speed = 1;
  DdsSettings dds;
};

std::vector<DiscoveredEndpoint> endpoints_of_others(const DdsListener& listener) {
  std::vector<DiscoveredEndpoint> endpoints = listener.endpoints();
  std::erase_if(endpoints,
                [](const DiscoveredEndpoint& endpoint) { return endpoint.participant == kParticipant; });
  return endpoints;
}

/// Writes the messages of a recording at their recorded intervals, divided by the speed.
class Replay {
 public:
  explicit Replay(const ReplayOptions& options)
      : options_(options), listener_(options.dds), playback_(options.file), bus_(options.dds) {}

  int run() {
    const StopSignals stop_signals([this] {
      is_stopped_ = true;
      playback_.stop();
      listener_.stop();
      bus_.stop();
    });
    commands_ = std::ranges::any_of(
        all_topics(), [this](const TopicInfo& topic) { return is_chosen(topic) && is_commanding(topic); });
    listener_.run_until(listener_.now() + kDiscovery);
    if (!check_domain()) return kExitFailure;
    const Scenario scenario = playback_.scenario();
    for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
      if (!is_chosen(topic)) return;
      for (std::size_t i = 0; i < (topic.per_robot ? scenario.robots.size() : 1); ++i)
        relay(topic, scenario.robots.empty() ? 0 : scenario.robots[i].id);
    });
    // Readers must know the writers before the first message.
    bus_.run_until(bus_.now() + kDiscovery);
    const PlaybackResult result = playback_.play();
    bus_.run_until(bus_.now() + kWriterLinger);
    print_output("{} messages written\n", written_);
    if (!result.damage.empty())
      fmt::print(stderr, "{}: {}; earlier messages were written\n", options_.file, result.damage);
    return is_refused_ || !result.damage.empty() ? kExitFailure : 0;
  }

 private:
  bool is_chosen(const TopicInfo& topic) const {
    return options_.topics.empty() || std::ranges::find(options_.topics, topic.name) != options_.topics.end();
  }

  /// Whether the domain permits the replay. If not, prints the reason.
  bool check_domain() {
    if (!commands_) return true;
    const auto reason = reason_against_replay(endpoints_of_others(listener_));
    if (!reason) return true;
    fmt::print(
        stderr,
        "refused: {}; replayed commands must not reach running agents, coordinators or robots. Use another "
        "--domain, or --topics without commands\n",
        *reason);
    is_refused_ = true;
    return false;
  }

  template <typename Message>
  void relay(const Topic<Message>& topic, RobotId robot) {
    const std::string channel = channel_name(topic, robot);
    writers_[channel] = bus_.relay(topic, channel);
    playback_.observe<Message>(topic, robot,
                               [this, writer = writers_[channel].get()](const Message& message) {
                                 if (!wait_for(playback_.now())) return playback_.stop();
                                 writer->write(&message);
                                 ++written_;
                               });
  }

  /// Waits until it is time to write a message. False: the replay is over.
  bool wait_for(Time recorded_at) {
    if (!begun_at_) {
      begun_at_ = checked_at_ = bus_.now();
      recorded_from_ = recorded_at;
    }
    bus_.run_until(*begun_at_ + from_seconds(to_seconds(recorded_at - recorded_from_) / options_.speed));
    if (bus_.now() - checked_at_ >= kCheckPeriod) {
      checked_at_ = bus_.now();
      if (!check_domain()) return false;
    }
    return !is_stopped_;
  }

  const ReplayOptions& options_;
  DdsListener listener_;
  PlaybackBus playback_;
  DdsBus bus_;
  std::map<std::string, std::unique_ptr<RawWriter>> writers_;
  std::optional<Time> begun_at_;
  Time recorded_from_{}, checked_at_{};
  std::uint64_t written_ = 0;
  bool commands_ = false, is_refused_ = false;
  std::atomic<bool> is_stopped_ = false;
};

}  // namespace

void add_replay_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<ReplayOptions>();
  options->dds.participant = kParticipant;
  const CliCommand command =
      root.add_subcommand("replay", "Writes the messages of a recording to a DDS domain");
  command.add_option("FILE", options->file, "recording").required();
  command.add_option("--topics", options->topics, "topics, e.g. world,truth [all]").comma_separated();
  command.add_option("--speed", options->speed, "multiple of real time").check(positive()).show_default();
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] {
    for (const std::string& name : options->topics) {
      const std::vector<TopicInfo> known = all_topics();
      if (std::ranges::none_of(known, [&](const TopicInfo& topic) { return topic.name == name; }))
        throw UsageError(fmt::format("--topics: there is no topic '{}'", name));
    }
    if (!options->dds.keys.empty())
      throw UsageError(
          "--keys: a replay repeats other processes' messages, which no key allows; replay without keys");
    action = [options] { return Replay(*options).run(); };
  });
}

}  // namespace sidestep
