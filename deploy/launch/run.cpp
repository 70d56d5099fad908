// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/run.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <optional>

#include "common/config/scenario_loader.hpp"
#include "common/process/process.hpp"
#include "deploy/launch/hosts/namespaces.hpp"
#include "deploy/launch/hosts/placement.hpp"
#include "deploy/launch/launcher.hpp"

namespace sidestep {

int run(const RunOptions& given) {
  RunOptions options = given;
  const Scenario scenario = load_scenario(options.scenario_file);
  fmt::print(stderr, "{}\n", budget_line(budget_of(scenario), scenario.margin_m));
  const Hosts hosts =
      options.hosts_file.empty() ? local_hosts(options.dds.interface) : load_hosts(options.hosts_file);
  const Placement placement(hosts, scenario);
  options.dds.interface = hosts.interface;
  std::optional<NamespaceNetwork> network;
  std::optional<ScopedNamespace> bridge;
  if (hosts.create) {
    remove_abandoned_namespaces();
    bridge.emplace(network.emplace(hosts).bridge());
  }
  const std::string report_path =
      options.report_file.empty() ? default_report_path(scenario.name, std::nullopt) : options.report_file;
  const std::string log_path = std::filesystem::path(report_path).replace_extension(".log").string();
  const Report report = Launcher(options, scenario, placement, network ? &*network : nullptr, log_path).run();
  write_report(report, report_path);
  fmt::print("\n{}: {}report: {}\nlog: {}\n", scenario.name, summary(report), report_path, log_path);
  return report.failure_reason().empty() ? 0 : kExitFailure;
}

}  // namespace sidestep
