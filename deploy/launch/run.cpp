// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/run.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "deploy/launch/hosts/run_hosts.hpp"
#include "deploy/launch/launcher.hpp"
#include "deploy/launch/process_keys.hpp"

namespace sidestep {

int run(const RunOptions& given) {
  RunOptions options = given;
  const Scenario scenario = load_scenario(options.scenario_file);
  fmt::print(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  if (scenario.has_test_keys)
    fmt::print(stderr, "faults and expectations in {} apply to `sidestep test` only\n",
               options.scenario_file);
  const RunHosts hosts(
      options.hosts_file.empty() ? local_hosts(options.dds.interface) : load_hosts(options.hosts_file),
      scenario, !options.floor.driver.empty());
  options.dds.interface = hosts.hosts().interface;
  if (!hosts.hosts().peers.empty()) options.dds.peers = hosts.hosts().peers;
  if (options.monitor_port && hosts.network())
    throw std::invalid_argument(
        "--monitor: a browser cannot reach the monitor in a network namespace; start `sidestep monitor` "
        "there");
  const std::string report_path =
      options.report_file.empty() ? default_report_path(scenario.name, std::nullopt) : options.report_file;
  const std::string log_path = std::filesystem::path(report_path).replace_extension(".log").string();
  require_keys(options, scenario);
  const Report report = Launcher(options, scenario, hosts.placement(), hosts.network(), log_path).run();
  write_report(report, report_path);
  fmt::print("\n{}: {}report: {}\nlog: {}\n", scenario.name, summary(report), report_path, log_path);
  return exit_code(report.verdict());
}

}  // namespace sidestep
