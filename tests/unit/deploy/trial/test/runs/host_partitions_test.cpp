// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/test/runs/host_partitions.hpp"

#include "common/yaml/config_error.hpp"
#include "tests/catch.hpp"

namespace sidestep::host_partitions_test {

FaultTest test_with(const std::string& faults) {
  return parse_fault_test(
      "coordinators: 2\nrobots:\n  - {id: 0, start_m: [-2, 0], goals_m: [[2, 0]]}\n"
      "  - {id: 1, start_m: [-2, 1], goals_m: [[2, 1]]}\n  - {id: 7, start_m: [-2, 2], goals_m: [[2, 2]]}\n"
      "faults: [" +
          faults + "]\nexpect: [{no_contact: all}]\n",
      "file.yaml");
}

/// Whether these processes share a host.
bool are_together(const FaultTest& test, const std::vector<std::string>& processes) {
  const Hosts hosts = hosts_for_partitions(test);
  const Placement placement(hosts, test.scenario);
  for (const std::string& process : processes) {
    if (&placement.host_of(process) != &placement.host_of(processes.front())) return false;
  }
  return true;
}

TEST_CASE("processes share a host if they are on the same side of every partition") {
  const FaultTest one = test_with("{at_s: 1, partition: [coordinator, agent 7], seconds: 1}");
  CHECK(hosts_for_partitions(one).hosts.size() == 2);
  CHECK(are_together(one, {"coordinator", "agent 7"}));
  CHECK(are_together(one, {"simulator", "vision", "coordinator 1", "agent 0", "agent 1"}));
  CHECK_FALSE(are_together(one, {"coordinator", "vision"}));
  const FaultTest two = test_with(
      "{at_s: 1, partition: [agent 0, agent 1], seconds: 1}, {at_s: 3, partition: agent 1, from: vision}");
  CHECK(hosts_for_partitions(two).hosts.size() == 4);
  CHECK_FALSE(are_together(two, {"agent 0", "agent 1"}));
  CHECK(are_together(two, {"simulator", "coordinator", "coordinator 1", "agent 7"}));
}

TEST_CASE("the hosts are namespaces with their own addresses, which the launcher creates") {
  const Hosts hosts = hosts_for_partitions(test_with("{at_s: 1, partition: vision, seconds: 1}"));
  CHECK(hosts.create);
  REQUIRE(hosts.hosts.size() == 2);
  CHECK(hosts.hosts[0].transport == HostTransport::kNamespace);
  CHECK(hosts.hosts[0].target != hosts.hosts[1].target);
  CHECK(hosts.hosts[0].interface != hosts.hosts[1].interface);
  CHECK(hosts.hosts[0].interface != hosts.interface);
}

TEST_CASE("partitions that do not separate whole namespace hosts are rejected with the reason") {
  const FaultTest test = test_with("{at_s: 1, partition: coordinator, seconds: 1}");
  const RunHosts local(local_hosts("127.0.0.1"), test.scenario);
  CHECK_THROWS_WITH(HostPartitions(test, local),
                    ContainsSubstring("partition coordinator needs a namespace host instead of local"));
  const Hosts shared = parse_hosts(
      "launcher: {interface: 10.77.0.254}\nhosts:\n"
      "  - {name: a, transport: {namespace: a}, interface: 10.77.0.1, processes: [coordinator, vision]}\n"
      "  - {name: b, transport: {namespace: b}, interface: 10.77.0.2, processes: [simulator], agents: rest, "
      "standbys: rest}\n",
      "hosts.yaml");
  const RunHosts hosts(shared, test.scenario);
  CHECK_THROWS_WITH(HostPartitions(test, hosts),
                    ContainsSubstring("does not separate whole hosts: host a also runs vision"));
  const FaultTest whole = test_with("{at_s: 1, partition: [coordinator, vision], seconds: 1}");
  CHECK_NOTHROW(HostPartitions(whole, hosts));
}

}  // namespace sidestep::host_partitions_test
