// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <fmt/core.h>

#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/output_reader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/senders/sender_meter.hpp"
#include "deploy/inspect/topic/silence.hpp"
#include "deploy/inspect/topic/topic_channel.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"

namespace sidestep {
namespace {

bool measure(Bus& bus, const std::string& channel, SenderMeter& meter) {
  return subscribe_to_channel(bus, channel, [&bus, &meter](const TopicInfo&, const auto& message) {
    meter.add(message.header(), bus.now());
  });
}

int measure_in_recording(const TopicOptions& options) {
  SenderMeter meter;
  PlaybackBus bus(options.recording_file);
  if (!measure(bus, options.topic, meter)) return kExitFailure;
  const PlaybackResult result = bus.play();
  print_damage(options.recording_file, result.damage);
  if (meter.is_empty())
    fmt::print(stderr, "{}\n", recorded_silence_text(options.topic, options.recording_file, 0));
  else
    print_output("{}", meter.table());
  return !meter.is_empty() && result.damage.empty() ? 0 : kExitFailure;
}

int measure_live(const TopicOptions& options) {
  SenderMeter meter;
  DdsBus bus(options.dds);
  if (!measure(bus, options.topic, meter)) return kExitFailure;
  std::atomic<bool> is_stopped = false;
  const StopSignals stop_signals([&] {
    is_stopped = true;
    bus.stop();
  });
  stop_without_reader(bus);
  const Time end = options.seconds > 0 ? bus.now() + from_seconds(options.seconds) : Time::max();
  const auto is_silent = [&] { return meter.is_empty() && !is_stopped && !is_output_abandoned(); };
  explain_silence(
      bus, options, is_silent, [] { return 0; }, end);
  bus.run_until(end);
  if (meter.is_empty()) return is_output_abandoned() ? 0 : kExitFailure;
  print_output("{}", meter.table());
  return 0;
}

}  // namespace

int measure_delay(const TopicOptions& options) {
  return options.recording_file.empty() ? measure_live(options) : measure_in_recording(options);
}

}  // namespace sidestep
