// SPDX-License-Identifier: Apache-2.0
#include <atomic>
#include <fmt/core.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/file/console.hpp"
#include "common/messaging/dds/listener.hpp"
#include "common/process/output_reader.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/inspect/topic/describe.hpp"
#include "deploy/inspect/topic/idl/idl_decoder.hpp"
#include "deploy/inspect/topic/idl/idl_parser.hpp"
#include "deploy/inspect/topic/silence.hpp"
#include "deploy/inspect/topic/topic_channel.hpp"
#include "deploy/inspect/topic/topic_tools.hpp"
#include "deploy/inspect/topic/topic_writer.hpp"

namespace sidestep {
namespace {

/// Prints the messages of a channel, and calls `stop` when enough are printed.
bool print_channel(Bus& bus, const std::string& channel, MessagePrinter& printer,
                   const std::function<void()>& stop) {
  return subscribe_to_channel(bus, channel, [&printer, stop](const TopicInfo& topic, const auto& message) {
    printer.print_if_wanted(describe(topic, &message));
    if (printer.is_done()) stop();
  });
}

int echo_recording(const TopicOptions& options, MessagePrinter& printer) {
  PlaybackBus bus(options.recording_file);
  if (!print_channel(bus, options.topic, printer, [&bus] { bus.stop(); })) return kExitFailure;
  const PlaybackResult result = bus.play();
  print_damage(options.recording_file, result.damage);
  if (printer.printed() == 0)
    fmt::print(stderr, "{}\n",
               recorded_silence_text(options.topic, options.recording_file, printer.received()));
  return printer.printed() > 0 && result.damage.empty() ? 0 : kExitFailure;
}

/// The type of another program's topic. Throws IdlError if the IDL file does not define it.
IdlTypePtr find_type(const TopicOptions& options, const IdlTypes& types, const std::string& name) {
  const auto found = types.find(name);
  if (found != types.end() && found->second->kind == IdlType::Kind::kStruct) return found->second;
  std::string known;
  for (const auto& [known_name, type] : types)
    if (type->kind == IdlType::Kind::kStruct) known += (known.empty() ? "" : ", ") + known_name;
  throw IdlError(fmt::format("{} has no struct '{}', expected one of: {}", options.idl_file, name,
                             known.empty() ? "none" : known));
}

int echo_foreign(const TopicOptions& options, MessagePrinter& printer) {
  const IdlTypes types = load_idl(options.idl_file);
  IdlTypePtr type;
  if (!options.type.empty()) type = find_type(options, types, options.type);
  DdsListener listener(options.dds);
  const StopSignals stop_signals([&listener] { listener.stop(); });
  const std::optional<DiscoveredEndpoint> writer = find_writer(listener, options);
  if (!writer) return listener.stopped() ? 0 : kExitFailure;
  if (!type) type = find_type(options, types, writer->type);
  bool is_decodable = true;
  listener.listen(*writer, [&](const RawSample& sample) {
    try {
      printer.print_if_wanted(decode_by_idl(*type, sample.bytes));
    } catch (const IdlDecodingError& error) {
      fmt::print(stderr, "a message of '{}' is not a valid {}: {}\n", options.topic, type->name,
                 error.what());
      is_decodable = false;
    }
    if (printer.is_done() || !is_decodable) listener.stop();
  });
  while (!listener.stopped() && !is_output_abandoned()) listener.run_until(listener.now() + kReaderPeriod);
  return is_decodable ? 0 : kExitFailure;
}

}  // namespace

int echo_topic(const TopicOptions& options) {
  MessagePrinter printer(options.printer, [](const std::string& line) { print_output("{}\n", line); });
  if (!options.recording_file.empty()) return echo_recording(options, printer);
  if (!options.idl_file.empty()) return echo_foreign(options, printer);
  DdsBus bus(options.dds);
  std::atomic<bool> is_stopped = false;
  const StopSignals stop_signals([&] {
    is_stopped = true;
    bus.stop();
  });
  if (!print_channel(bus, options.topic, printer, [&bus] { bus.stop(); })) return kExitFailure;
  stop_without_reader(bus);
  const auto is_silent = [&] { return printer.printed() == 0 && !is_stopped && !is_output_abandoned(); };
  explain_silence(
      bus, options, is_silent, [&] { return printer.received(); }, Time::max());
  bus.run();
  return 0;
}

}  // namespace sidestep
