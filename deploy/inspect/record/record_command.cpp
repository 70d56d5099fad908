// SPDX-License-Identifier: Apache-2.0
#include "deploy/inspect/record/record_command.hpp"

#include <fmt/format.h>
#include <memory>
#include <optional>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/process/command_line.hpp"
#include "common/process/output_paths.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/recording.hpp"

namespace sidestep {
namespace {

struct RecordOptions {
  std::string scenario_file;
  std::string recording_file;
  std::optional<double> seconds;
  bool is_compressed = false;
  bool overwrites = false;
  DdsSettings dds;
};

int record_messages(const RecordOptions& options) {
  const Scenario scenario = load_scenario(options.scenario_file);
  const RecordingHeader header = recording_header(scenario, options.scenario_file);
  std::optional<RecordingWriter> writer;  // outlives the bus
  DdsBus bus(options.dds);
  writer.emplace(options.recording_file, header, McapWriterSettings{.is_compressed = options.is_compressed});
  record(bus, scenario, *writer);
  fmt::print(stderr, "recording domain {}{}\n", options.dds.domain, options.seconds ? "" : " until Ctrl-C");
  const StopSignals stop_signals([&bus] { bus.stop(); });
  writer->on_failure([&bus](const std::string&) { bus.stop(); });
  if (options.seconds)
    bus.run_until(bus.now() + from_seconds(*options.seconds));
  else
    bus.run();
  writer->close();
  print_output("{}: {} messages\n", options.recording_file, writer->messages());
  return writer->messages() > 0 ? 0 : kExitFailure;
}

}  // namespace

void add_record_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<RecordOptions>();
  options->dds.participant = "sidestep-record";
  options->dds.keeps_all = true;
  const CliCommand command =
      root.add_subcommand("record", "Records all messages of a running system except camera images");
  command.add_option("SCENARIO", options->scenario_file, "scenario file").required();
  command.add_option("--out", options->recording_file, "MCAP file to write").required();
  command.add_flag("--force", options->overwrites, "overwrite the file if it exists");
  command.add_flag("--compress", options->is_compressed, "compress the messages with zstd");
  command.add_option("--seconds", options->seconds, "duration [until Ctrl-C]").check(positive());
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] {
    require_separate_outputs({{"SCENARIO", options->scenario_file}}, {{"--out", options->recording_file}});
    require_new_output({"--out", options->recording_file}, options->overwrites);
    action = [options] { return record_messages(*options); };
  });
}

}  // namespace sidestep
