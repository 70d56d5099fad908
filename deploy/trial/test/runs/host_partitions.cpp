// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/host_partitions.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <stdexcept>

#include "common/protocol/process_names.hpp"
#include "deploy/trial/fault/link_filter.hpp"
#include "deploy/trial/simulate/system/system_processes.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxPartitionHosts = 250;

bool contains(const std::vector<std::string>& processes, const std::string& process) {
  return std::ranges::find(processes, process) != processes.end();
}

/// For each partition, the side that a process is on.
std::string sides_of(const std::string& process, const FaultTest& test) {
  std::string sides;
  for (const PlannedFault& fault : test.faults) {
    const auto* partition = std::get_if<Partition>(&fault.action);
    if (partition)
      sides += contains(partition->from, process) ? 'f' : contains(partition->to, process) ? 't' : '-';
  }
  return sides;
}

}  // namespace

Hosts hosts_for_partitions(const FaultTest& test) {
  std::map<std::string, HostSpec> by_sides;
  const auto host_of = [&](const std::string& process) -> HostSpec& {
    return by_sides[sides_of(process, test)];
  };
  host_of("simulator").simulator = true;
  host_of("vision").vision = true;
  host_of("coordinator").coordinator = true;
  for (int number = 1; number < test.scenario.coordinators; ++number) {
    const auto n = static_cast<std::uint32_t>(number);
    host_of(coordinator_process(number)).standbys.ranges.push_back({n, n, 1});
  }
  for (const RobotSpec& robot : test.scenario.robots)
    host_of(agent_process(robot.id)).agents.ranges.push_back({robot.id, robot.id, 1});
  Hosts hosts;
  hosts.file = test.file;
  hosts.create = true;
  hosts.interface = "10.77.0.254";
  if (by_sides.size() > kMaxPartitionHosts)
    throw std::runtime_error(fmt::format("the partitions need {} hosts, at most {} are possible",
                                         by_sides.size(), kMaxPartitionHosts));
  for (auto& [sides, host] : by_sides) {
    const std::size_t number = hosts.hosts.size() + 1;
    host.name = host.target = fmt::format("side-{}", number);
    host.transport = HostTransport::kNamespace;
    host.interface = fmt::format("10.77.0.{}", number);
    hosts.hosts.push_back(host);
  }
  return hosts;
}

HostPartitions::HostPartitions(const FaultTest& test, const RunHosts& hosts) : test_(test), hosts_(hosts) {
  for (const PlannedFault& fault : test.faults) {
    if (const auto* partition = std::get_if<Partition>(&fault.action)) check(*partition, fault.text);
  }
}

HostPartitions::~HostPartitions() {
  for (const auto& [host, senders] : cuts_) {
    try {
      clear_link_fault(hosts_.namespace_name(*host));
    } catch (const std::runtime_error& error) {
      fmt::print(stderr, "sidestep: {}\n", error.what());
    }
  }
}

HostPartitions::HostSet HostPartitions::hosts_of(const std::vector<std::string>& processes) const {
  HostSet hosts;
  for (const std::string& process : processes) hosts.insert(&hosts_.placement().host_of(process));
  return hosts;
}

void HostPartitions::check(const Partition& partition, const std::string& text) const {
  for (const auto* side : {&partition.from, &partition.to}) {
    const HostSet hosts = hosts_of(*side);
    for (const HostSpec* host : hosts) {
      if (host->transport != HostTransport::kNamespace)
        throw std::runtime_error(fmt::format("{} needs a namespace host instead of {}", text, host->name));
    }
    for (const std::string& process : system_process_names(test_.scenario)) {
      const HostSpec& host = hosts_.placement().host_of(process);
      if (!hosts.contains(&host) || contains(*side, process)) continue;
      throw std::runtime_error(
          fmt::format("{} does not separate whole hosts: host {} also runs {}", text, host.name, process));
    }
  }
}

void HostPartitions::change(const Partition& partition, int count) {
  const HostSet senders = hosts_of(partition.from), receivers = hosts_of(partition.to);
  for (const HostSpec* sender : senders) {
    for (const HostSpec* receiver : receivers) {
      cuts_[receiver][sender->interface] += count;
      if (partition.is_two_way) cuts_[sender][receiver->interface] += count;
    }
  }
  for (const HostSpec* host : receivers) set_filter(*host);
  for (const HostSpec* host : senders) set_filter(*host);
}

void HostPartitions::set_filter(const HostSpec& host) const {
  const auto senders = cuts_.find(&host);
  if (senders == cuts_.end()) return;
  LinkFault fault;
  for (const auto& [address, count] : senders->second) {
    if (count > 0) fault.cut_from.push_back(address);
  }
  set_link_fault(hosts_.namespace_name(host), fault);
}

}  // namespace sidestep
