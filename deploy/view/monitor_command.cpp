// SPDX-License-Identifier: Apache-2.0
#include "deploy/view/monitor_command.hpp"

#include <atomic>
#include <csignal>
#include <fmt/format.h>
#include <memory>
#include <string>

#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/inspect/record/playback_bus.hpp"
#include "deploy/view/monitor/recorded_messages.hpp"
#include "deploy/view/monitor_options.hpp"
#include "deploy/view/monitor_server.hpp"
#include "deploy/view/monitored_system.hpp"

namespace sidestep {
namespace {

using namespace std::chrono_literals;

constexpr Duration kServePeriod = 5ms;

int monitor_recording(const MonitorOptions& options) {
  PlaybackBus bus(options.file);
  const Scenario scenario = bus.scenario();
  MonitorSettings settings;
  settings.scenario = &scenario;
  settings.is_recording = true;
  settings.audit.is_complete = bus.header().is_complete;
  RecordedMessages recorded(options.file, bus);
  settings.recorded_messages = [&recorded](const std::string& channel, Time from, Time to) {
    return recorded.between(channel, from, to);
  };
  Monitor monitor(bus, settings);
  MonitorServer server(options.access, monitor, {});
  server.announce();
  bus.on_event([&monitor](Time at, const std::string& kind, const std::string& text) {
    monitor.events().add({0, at, Severity::kInfo, kind, text});
  });
  std::atomic<bool> is_stopped = false;
  const StopSignals stop_signals([&] {
    is_stopped = true;
    bus.stop();
  });
  PlaybackResult result;
  Time next_snapshot{}, next_update{};
  bool is_over = false;
  while (!is_stopped) {
    // Keeps reading as fast as possible, and serves viewers meanwhile.
    for (int i = 0; i < 500 && !is_over; ++i) {
      is_over = !bus.play_next(result);
      if (!is_over && bus.now() < next_snapshot) continue;
      monitor.set_progress(is_over ? 1 : bus.progress());
      is_over ? monitor.take_last_snapshot() : monitor.take_snapshot();
      next_snapshot = bus.now() + Monitor::kFramePeriod;
      if (is_over && !result.damage.empty())
        fmt::print(stderr, "{}: {}; earlier messages are shown\n", options.file, result.damage);
    }
    if (const Time clock = DdsBus::clock(); clock >= next_update) {
      server.update(clock);
      next_update = clock + Monitor::kFramePeriod;
    }
    is_over ? server.server().run_for(kServePeriod) : server.server().poll();
  }
  return 0;
}

}  // namespace

void add_monitor_command(const CliCommand& root, std::function<int()>& action) {
  const auto options = std::make_shared<MonitorOptions>();
  options->dds.participant = "sidestep-monitor";
  options->dds.keeps_all = true;
  const CliCommand command =
      root.add_subcommand("monitor", "Shows a running system or a recording in the browser");
  command.add_option("FILE", options->file,
                     "scenario of the running system, or a recording (.mcap); without it, nothing is judged");
  command.add_option("--port", options->port, "TCP port; 0: any free port")
      .check(in_range(0, 65535))
      .show_default();
  command.add_option("--address", options->access.address, "address to listen on").show_default();
  command
      .add_option("--allow-origin", options->access.allowed_origins,
                  "servers whose pages may use this server, e.g. https://example.org")
      .comma_separated();
  command.add_flag("--control", options->has_control,
                   "viewers with the printed token may give orders and cause faults");
  command.add_option("--record", options->recording_file,
                     "also write all messages to this MCAP file; an earlier file is replaced");
  command.add_flag(
      "--of-run", options->is_of_run,
      "for `sidestep run`, whose monitor this is: read from stdin the token, and whether the run "
      "is over");
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] {
    if (options->shows_recording() && options->has_control)
      throw UsageError("--control: a recording cannot be commanded");
    if (options->is_of_run && (options->file.empty() || options->shows_recording()))
      throw UsageError("--of-run: needs the scenario file of the run");
    if (!options->recording_file.empty() && (options->file.empty() || options->shows_recording()))
      throw UsageError("--record: needs the scenario file of a running system");
    options->access.port = static_cast<std::uint16_t>(options->port);
    if (options->has_control) {
      options->access.token = random_token();  // that of the run replaces it
      options->dds.is_operator = true;
      options->dds.identity = {Role::kOperator};
    }
    action = [options] {
      // The page is served, and the recording written, even if nobody reads the page's address.
      std::signal(SIGPIPE, SIG_IGN);
      return options->shows_recording() ? monitor_recording(*options) : monitor_system(*options);
    };
  });
}

}  // namespace sidestep
