// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/clock/clock_command.hpp"

#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <string>
#include <unistd.h>

#include "common/file/console.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/host_name.hpp"
#include "common/process/network_text.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "common/protocol/process_names.hpp"
#include "common/terminal/redrawn_text.hpp"
#include "common/terminal/terminal.hpp"
#include "deploy/run/clock/clock_survey.hpp"
#include "deploy/run/clock/clock_text.hpp"

namespace sidestep {
namespace {

constexpr Duration kProbePeriod = std::chrono::milliseconds(100);
constexpr Duration kTablePeriod = std::chrono::milliseconds(500);
// Discovery takes up to half a second; processes that do not answer probes are heard once a second.
constexpr Duration kOnceDuration = std::chrono::milliseconds(2500);

struct ClockOptions {
  DdsSettings dds;
  std::optional<std::uint32_t> reference;  ///< id of a process; nullopt: this command's own clock
  std::string reference_name;
  bool once = false;
};

/// Sends probes, and passes on what processes report about their clocks.
class ClockProber {
 public:
  ClockProber(Bus& bus, std::uint32_t client)
      : bus_(bus), client_(client), survey_(client), writer_(bus.advertise(topics::kClockProbe)) {
    bus_.subscribe(topics::kClockReading, [this](const msg::ClockReading& message) {
      if (const auto answer = decode(message)) survey_.on_answer(*answer, bus_.now());
    });
    bus_.subscribe(topics::kCounters, [this](const msg::Counters& message) {
      const bool is_own = message.header().sender() == message.process();
      if (is_own && process_id(process_name(message.process())))
        survey_.on_heard(message.process(), bus_.now());
    });
    bus_.subscribe(topics::kStatus, [this](const msg::AgentStatus& message) { on_status(message); });
    probe();
  }
  ClockProber(const ClockProber&) = delete;
  ClockProber& operator=(const ClockProber&) = delete;

  const ClockSurvey& survey() const { return survey_; }

 private:
  void on_status(const msg::AgentStatus& message) {
    constexpr double kMax_s = 1e9;
    const double offset_s = message.clock_offset_s(), uncertainty_s = message.clock_uncertainty_s();
    if (message.robot() >= kMaxRobots || message.header().sender() != message.robot()) return;
    // A NaN counts as not measured.
    const bool is_measured = std::abs(offset_s) < kMax_s && uncertainty_s >= 0 && uncertainty_s < kMax_s;
    survey_.on_robot_clock(message.robot(),
                           is_measured ? std::optional(OffsetInterval{from_seconds(offset_s - uncertainty_s),
                                                                      from_seconds(offset_s + uncertainty_s)})
                                       : std::nullopt,
                           bus_.now());
  }

  void probe() {
    bus_.at(bus_.now() + kProbePeriod, [this] { probe(); });
    msg::ClockProbe message;
    message.client(client_);
    message.header().sender(client_);
    writer_.publish(message, bus_.now());
    survey_.on_probe(time_from_ns(message.header().stamp_ns()));
  }

  Bus& bus_;
  const std::uint32_t client_;
  ClockSurvey survey_;
  Writer<msg::ClockProbe> writer_;
};

int show_clocks(const ClockOptions& options) {
  DdsBus bus(options.dds);
  const StopSignals stop_signals([&bus] { bus.stop(); });
  const ClockProber prober(bus, client_id(fmt::format("clock {} {}", host_name(), getpid())));
  const auto rows = [&] { return prober.survey().rows(bus.now(), options.reference); };
  if (options.once || !terminal_of(STDOUT_FILENO).can_redraw) {
    bus.run_until(bus.now() + kOnceDuration);
    write_output(to_table(rows(), options.reference_name));
  } else {
    RedrawnText table(stdout);
    const auto refresh = [&] { table.draw(to_table(rows(), options.reference_name)); };
    refresh();
    call_periodically(bus, kTablePeriod, refresh);
    bus.run();
  }
  if (rows().empty()) fmt::print(stderr, "sidestep: no process is heard {}\n", network_text(options.dds));
  return all_agree(rows()) ? 0 : kExitFailure;
}

}  // namespace

void add_clock_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand command = root.add_subcommand("clock", "Shows the offsets of the processes' clocks");
  const auto options = std::make_shared<ClockOptions>();
  options->dds.participant = "sidestep-clock";
  options->dds.identity = {Role::kOperator};
  options->reference_name = "this machine";
  add_dds_options(command, options->dds);
  command.add_option(
      "--from",
      [options](const std::string& name) {
        options->reference = process_id(name);
        options->reference_name = name;
        if (!options->reference) throw UsageError("there is no process named '" + name + "'");
      },
      "process whose clock is the reference for offsets, e.g. coordinator; default: this machine");
  command.add_flag("--once", options->once, "print the table once, and exit");
  command.on_parsed([options, &action] { action = [options] { return show_clocks(*options); }; });
}

}  // namespace sidestep
