// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/link_command.hpp"

#include <csignal>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <string>

#include "common/file/console.hpp"
#include "common/messaging/dds/event_loop.hpp"
#include "common/process/command_line.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/trial/fault/link_filter.hpp"

namespace sidestep {
namespace {

struct LinkOptions {
  std::string host;
  double loss = 1;
  std::string one_way;
  std::optional<double> seconds;
};

LinkFault fault_from(const LinkOptions& options, bool is_partition) {
  // Loss applies to incoming packets only, so a packet between two impaired hosts is at risk once.
  if (!is_partition) return {options.loss, 0};
  return {options.one_way == "out" ? 0.0 : 1.0, options.one_way == "in" ? 0.0 : 1.0};
}

void heal(const std::vector<std::string>& namespaces) {
  for (const std::string& name : namespaces) clear_link_fault(name);
  print_output("{}: healed\n", fmt::join(namespaces, ", "));
}

int apply(const LinkOptions& options, const LinkFault& fault) {
  // The fault ends after --seconds even if the reader of the output disappears.
  std::signal(SIGPIPE, SIG_IGN);
  const auto namespaces = namespaces_of_host(options.host);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  for (const std::string& name : namespaces) set_link_fault(name, fault);
  const int output_error =
      write_text(stdout, fmt::format("{}: drops {:.4g} % of incoming and {:.4g} % of outgoing packets\n",
                                     fmt::join(namespaces, ", "), 100 * fault.loss_in, 100 * fault.loss_out));
  if (options.seconds) {
    loop.run_until(EventLoop::now() + from_seconds(*options.seconds));
    heal(namespaces);
  }
  require_printed(output_error);
  return 0;
}

}  // namespace

void add_link_commands(const CliCommand& fault, std::function<int()>& action) {
  const auto options = std::make_shared<LinkOptions>();
  const auto add = [&](const char* name, const char* description) {
    const CliCommand command = fault.add_subcommand(name, description);
    command.add_option("HOST", options->host, "the namespace as named in the hosts file; all: every host")
        .required();
    return command;
  };
  const CliCommand partition =
      add("partition", "Cuts a host off from all others (needs namespace hosts and root)");
  partition.add_option("--one-way", options->one_way, "drop only incoming or only outgoing packets")
      .check(one_of({"in", "out"}));
  partition.on_parsed(
      [options, &action] { action = [options] { return apply(*options, fault_from(*options, true)); }; });

  const CliCommand link = add("link", "Drops incoming packets of a host (needs namespace hosts and root)");
  link.add_option("--loss", options->loss, "loss probability").required().check(in_range(0.0, 1.0));
  link.on_parsed(
      [options, &action] { action = [options] { return apply(*options, fault_from(*options, false)); }; });
  for (const CliCommand& command : {partition, link}) {
    command.add_option("--seconds", options->seconds, "duration [until `fault heal`]").check(positive());
  }

  const CliCommand heal_command = add("heal", "Ends `partition` and `link` of a host");
  heal_command.on_parsed([options, &action] {
    action = [options] {
      heal(namespaces_of_host(options->host));
      return 0;
    };
  });
}

}  // namespace sidestep
