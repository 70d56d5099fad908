// SPDX-License-Identifier: Apache-2.0
#include "deploy/fault/link_command.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <string>

#include "common/messaging/dds/event_loop.hpp"
#include "common/process/stop_signals.hpp"
#include "deploy/fault/link_filter.hpp"

namespace sidestep {
namespace {

struct LinkOptions {
  std::string host;
  double loss = 1;
  std::string one_way;
  std::optional<double> seconds;
};

LinkFault fault_from(const LinkOptions& options, bool is_partition) {
  // Loss is on what arrives only: with all hosts set, a packet from one to another is at risk once.
  if (!is_partition) return {options.loss, 0};
  return {options.one_way == "out" ? 0.0 : 1.0, options.one_way == "in" ? 0.0 : 1.0};
}

void heal(const std::vector<std::string>& namespaces) {
  for (const std::string& name : namespaces) clear_link_fault(name);
  fmt::print("{}: healed\n", fmt::join(namespaces, ", "));
}

int disturb(const LinkOptions& options, const LinkFault& fault) {
  const auto namespaces = namespaces_of_host(options.host);
  EventLoop loop;
  const StopSignals stop_signals([&loop] { loop.stop(); });
  for (const std::string& name : namespaces) set_link_fault(name, fault);
  fmt::print("{}: drops {:.4g} % of what arrives and {:.4g} % of what leaves\n", fmt::join(namespaces, ", "),
             100 * fault.loss_in, 100 * fault.loss_out);
  if (!options.seconds) return 0;
  std::fflush(stdout);
  loop.run_until(EventLoop::now() + from_seconds(*options.seconds));
  heal(namespaces);
  return 0;
}

}  // namespace

void add_link_commands(CLI::App& fault, std::function<int()>& action) {
  const auto options = std::make_shared<LinkOptions>();
  const auto add = [&](const char* name, const char* description) {
    CLI::App* const command = fault.add_subcommand(name, description);
    command->add_option("HOST", options->host, "as the hosts file calls its namespace; all: every one")
        ->required();
    return command;
  };
  CLI::App* partition = add("partition", "Cuts a host off from all others (network namespaces, root)");
  partition->add_option("--one-way", options->one_way, "cut only what comes in, or what goes out")
      ->check(CLI::IsMember({"in", "out"}));
  partition->callback(
      [options, &action] { action = [options] { return disturb(*options, fault_from(*options, true)); }; });

  CLI::App* link = add("link", "Loses packets that arrive at a host (network namespaces, root)");
  link->add_option("--loss", options->loss, "probability")->required()->check(CLI::Range(0.0, 1.0));
  link->callback(
      [options, &action] { action = [options] { return disturb(*options, fault_from(*options, false)); }; });
  for (CLI::App* command : {partition, link}) {
    command->add_option("--seconds", options->seconds, "heal after that; without it `fault heal` does")
        ->check(CLI::PositiveNumber);
  }

  CLI::App* whole = add("heal", "Ends partitions and loss of a host's packets");
  whole->callback([options, &action] {
    action = [options] {
      heal(namespaces_of_host(options->host));
      return 0;
    };
  });
}

}  // namespace sidestep
