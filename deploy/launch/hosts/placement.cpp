// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/placement.hpp"

#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "deploy/monitor/metrics/run_metrics.hpp"

namespace sidestep {

Placement::Placement(const Hosts& hosts, const Scenario& scenario) : hosts_(hosts) {
  place_single("simulator", &HostSpec::simulator);
  place_single("vision", &HostSpec::vision);
  place_single("coordinator", &HostSpec::coordinator);
  std::map<std::uint32_t, std::string> names;
  for (int i = 1; i < scenario.coordinators; ++i)
    names[static_cast<std::uint32_t>(i)] = coordinator_process(i);
  place_numbered(names, &HostSpec::standbys, "standbys");
  names.clear();
  for (const RobotSpec& robot : scenario.robots) names[robot.id] = agent_process(robot.id);
  place_numbered(names, &HostSpec::agents, "agents");
}

void Placement::place(const std::string& process, const HostSpec& host, int line) {
  const auto [at, is_new] = hosts_of_.emplace(process, &host);
  if (is_new) return;
  throw ScenarioError(
      hosts_.file, line,
      fmt::format("host {} runs the {}, but {} does already", host.name, process, at->second->name));
}

void Placement::place_single(const std::string& process, bool HostSpec::*flag) {
  for (const HostSpec& host : hosts_.hosts) {
    if (host.*flag) place(process, host, host.line);
  }
  if (!hosts_of_.count(process))
    throw ScenarioError(hosts_.file, 1, "no host runs the " + process + ", expected one");
}

void Placement::place_numbered(const std::map<std::uint32_t, std::string>& names,
                               NumberedShare HostSpec::*share, const std::string& key) {
  std::vector<const HostSpec*> takers;
  for (const HostSpec& host : hosts_.hosts) {
    for (const NumberedShare::Range& range : (host.*share).ranges) {
      const auto first = names.lower_bound(range.first), last = names.upper_bound(range.last);
      if (first == last) {
        throw ScenarioError(hosts_.file, range.line,
                            fmt::format("host {} runs {} {}-{}, of which the scenario has none", host.name,
                                        key, range.first, range.last));
      }
      for (auto i = first; i != last; ++i) place(i->second, host, range.line);
    }
    if ((host.*share).rest) takers.push_back(&host);
  }
  std::size_t turn = 0;
  for (const auto& [number, name] : names) {
    if (hosts_of_.count(name)) continue;
    if (takers.empty()) throw ScenarioError(hosts_.file, 1, "no host runs " + name + ", expected one");
    hosts_of_[name] = takers[turn++ % takers.size()];
  }
}

}  // namespace sidestep
