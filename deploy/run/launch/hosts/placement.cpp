// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/hosts/placement.hpp"

#include <fmt/format.h>

#include "common/config/scenario_loader.hpp"
#include "common/protocol/process_names.hpp"

namespace sidestep {

Placement::Placement(const Hosts& hosts, const Scenario& scenario, bool has_driver) : hosts_(hosts) {
  if (has_driver)
    place_single("robots", &HostSpec::robots);
  else
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
  const auto [entry, is_new] = host_by_process_.emplace(process, &host);
  if (is_new) return;
  throw ConfigError(
      hosts_.file, line,
      fmt::format("host {} runs {}, but host {} runs it already", host.name, process, entry->second->name));
}

void Placement::place_single(const std::string& process, bool HostSpec::*flag) {
  for (const HostSpec& host : hosts_.hosts) {
    if (host.*flag) place(process, host, host.line);
  }
  if (!host_by_process_.count(process)) throw ConfigError(hosts_.file, 1, "no host runs " + process);
}

void Placement::place_numbered(const std::map<std::uint32_t, std::string>& names,
                               NumberedShare HostSpec::*share, const std::string& key) {
  std::vector<const HostSpec*> sharing_hosts;
  for (const HostSpec& host : hosts_.hosts) {
    for (const NumberedShare::Range& range : (host.*share).ranges) {
      const auto first = names.lower_bound(range.first), last = names.upper_bound(range.last);
      if (first == last) {
        throw ConfigError(hosts_.file, range.line,
                          fmt::format("host {} runs {} {}-{}, but the scenario has none of them", host.name,
                                      key, range.first, range.last));
      }
      for (auto i = first; i != last; ++i) place(i->second, host, range.line);
    }
    if ((host.*share).rest) sharing_hosts.push_back(&host);
  }
  std::size_t next = 0;
  for (const auto& [number, name] : names) {
    if (host_by_process_.count(name)) continue;
    if (sharing_hosts.empty()) throw ConfigError(hosts_.file, 1, "no host runs " + name);
    host_by_process_[name] = sharing_hosts[next++ % sharing_hosts.size()];
  }
}

}  // namespace sidestep
