// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/network_command.hpp"

#include <csignal>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <vector>

#include "common/file/console.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/messaging/impairment.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/trial/fault/fault_target.hpp"
#include "deploy/trial/fault/network_message.hpp"
#include "deploy/trial/fault/operator_messages.hpp"

namespace sidestep {
namespace {

struct NetworkOptions {
  std::string target;
  double loss = 0;
  double burst = 1;
  double duplicate = 0;
  std::vector<double> delay_ms{0, 0, 0};
  bool is_cut = false;
  bool is_clear = false;
  std::uint64_t seed = 1;
  std::optional<double> seconds;
  DdsSettings dds;
};

msg::NetworkFault fault_from(const NetworkOptions& options, std::uint32_t target) {
  const auto delay = [&](std::size_t i) { return from_seconds(options.delay_ms[i] * 1e-3); };
  const LinkQuality quality{options.loss, options.burst, options.duplicate, delay(0),
                            delay(1),     delay(2),      options.is_cut};
  return encode(quality, target, options.seed);
}

void send(OperatorChannel& channel, msg::NetworkFault fault) {
  fault.header(operator_header());
  channel.writer().write(&fault);
  wait_until_acknowledged(channel);
}

int apply(const NetworkOptions& options) {
  // The fault ends after --seconds even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const auto target = parse_fault_target(options.target);
  const msg::NetworkFault fault = fault_from(options, target->number);
  OperatorChannel channel(options.dds, topics::kNetworkFault);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  const std::vector<std::string> impaired =
      wait_for_targets(channel, options.dds, target->participant, "; start the run with --faults");
  send(channel, fault);
  int output_error = write_text(stdout, fmt::format("applied to {}\n", fmt::join(impaired, ", ")));
  if (options.seconds) {
    loop.run_until(EventLoop::now() + from_seconds(*options.seconds));
    send(channel, encode(kUnimpairedLink, target->number, 0));
    if (output_error == 0) output_error = write_text(stdout, "cleared\n");
  }
  require_printed(output_error);
  return 0;
}

/// The reason why the combination of options is invalid; empty if it is valid.
std::string usage_error(const NetworkOptions& options) {
  if (!parse_fault_target(options.target))
    return "--target: expected all, 'agent N', coordinator, 'coordinator N', vision, simulator or robots, "
           "got '" +
           options.target + "'";
  const bool is_empty = link_quality_from(fault_from(options, 0)) == kUnimpairedLink;
  if (options.is_clear != is_empty)
    return options.is_clear ? "--clear cannot be combined with a fault"
                            : "expected --clear, --cut, --loss, --delay-ms or --duplicate";
  if (!link_quality_from(fault_from(options, 0)))
    return "--delay-ms: expected MIN,MEAN,MAX in increasing order, at most 10000";
  if (options.burst > 1 && options.loss <= 0) return "--burst requires --loss";
  if (options.is_clear && options.seconds) return "--seconds cannot be combined with --clear";
  return "";
}

}  // namespace

void add_network_command(const CliCommand& fault, std::function<int()>& action) {
  const auto options = std::make_shared<NetworkOptions>();
  options->dds.participant = "sidestep-fault";
  options->dds.identity = {Role::kOperator};
  const CliCommand command = fault.add_subcommand(
      "network", "Loses, delays and duplicates messages at processes started with --faults");
  command
      .add_option(
          "--target", options->target,
          "receiving process: all, 'agent 3', coordinator, 'coordinator 1', vision, simulator, robots")
      .required();
  command.add_option("--loss", options->loss, "loss probability").check(in_range(0.0, 1.0));
  command.add_option("--burst", options->burst, "mean number of consecutive losses")
      .check(in_range(1.0, 1e6));
  command.add_option("--duplicate", options->duplicate, "duplication probability").check(in_range(0.0, 1.0));
  command.add_option("--delay-ms", options->delay_ms, "MIN,MEAN,MAX delay, e.g. 5,20,150")
      .comma_separated(3)
      .check(in_range(0.0, 10000.0));
  command.add_flag("--cut", options->is_cut, "lose all messages");
  command.add_flag("--clear", options->is_clear, "end the fault");
  command.add_option("--seed", options->seed, "random seed of the fault").show_default();
  command.add_option("--seconds", options->seconds, "duration [until --clear]").check(positive());
  add_dds_options(command, options->dds);
  command.on_parsed([options, &action] {
    if (const std::string error = usage_error(*options); !error.empty()) throw UsageError(error);
    action = [options] { return apply(*options); };
  });
}

}  // namespace sidestep
