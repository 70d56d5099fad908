// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "common/file/console.hpp"
#include "common/process/output_reader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/senders/sender_meter.hpp"
#include "deploy/inspect/topic/topic_channel.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"

namespace sidestep {
namespace {

bool measure(Bus& bus, const std::string& channel, SenderMeter& meter) {
  return subscribe_to_channel(bus, channel, [&bus, &meter](const TopicInfo&, const auto& message) {
    meter.add(message.header(), bus.now());
  });
}

}  // namespace

int measure_delay(const TopicOptions& options) {
  SenderMeter meter;
  bool is_damaged = false;
  if (!options.recording_file.empty()) {
    PlaybackBus bus(options.recording_file);
    if (!measure(bus, options.topic, meter)) return kExitFailure;
    const PlaybackResult result = bus.play();
    print_damage(options.recording_file, result.damage);
    is_damaged = !result.damage.empty();
  } else {
    DdsBus bus(options.dds);
    if (!measure(bus, options.topic, meter)) return kExitFailure;
    const StopSignals stop_signals([&bus] { bus.stop(); });
    stop_without_reader(bus);
    if (options.seconds > 0)
      bus.run_until(bus.now() + from_seconds(options.seconds));
    else
      bus.run();
  }
  print_output("{}", meter.table());
  return is_damaged ? kExitFailure : 0;
}

}  // namespace sidestep
