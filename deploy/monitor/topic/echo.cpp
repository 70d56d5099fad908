// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/monitor/record/playback_bus.hpp"
#include "deploy/monitor/topic/describe.hpp"
#include "deploy/monitor/topic/topic_channel.hpp"
#include "deploy/monitor/topic/topic_tools.hpp"

namespace sidestep {
namespace {

/// Prints the messages of a channel, and calls `stop` when enough are printed.
bool print_channel(Bus& bus, const std::string& channel, MessagePrinter& printer,
                   const std::function<void()>& stop) {
  return subscribe_to_channel(bus, channel, [&printer, stop]<typename Message>(const Message& message) {
    printer.add(describe(message));
    if (printer.is_done()) stop();
  });
}

int echo_recording(const TopicOptions& options, MessagePrinter& printer) {
  PlaybackBus bus(options.recording_file);
  if (!print_channel(bus, options.topic, printer, [&bus] { bus.stop(); })) return kExitFailure;
  const PlaybackResult result = bus.play();
  print_damage(options.recording_file, result.damage);
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
