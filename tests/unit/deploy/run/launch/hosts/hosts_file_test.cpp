// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/hosts/hosts_file.hpp"

#include <algorithm>

#include "common/config/scenario_loader.hpp"
#include "deploy/run/launch/hosts/placement.hpp"
#include "tests/catch.hpp"

namespace sidestep::hosts_file_test {

const std::string kTwoHosts = R"(launcher: {interface: 10.1.0.9}
hosts:
  - name: floor
    transport: local
    interface: 10.1.0.1
    processes: [simulator, vision, coordinator]
    agents: [0-2, 7]
  - name: far
    transport: {ssh: robot@far.example}
    interface: 10.1.0.2
    programs: /opt/sidestep/bin
    agents: rest
)";

std::string with(std::string text, const std::string& old_text, const std::string& new_text) {
  const auto position = text.find(old_text);
  REQUIRE(position != std::string::npos);
  return text.replace(position, old_text.size(), new_text);
}

void check_refused(const std::string& text, const std::string& prefix, const std::string& part) {
  INFO(text);
  try {
    (void)parse_hosts(text, "hosts.yaml");
    FAIL("the hosts file was accepted");
  } catch (const ConfigError& error) {
    INFO(error.what());
    CHECK(std::string(error.what()).rfind(prefix, 0) == 0);
    CHECK(std::string(error.what()).find(part) != std::string::npos);
  }
}

Scenario eight_robots() { return parse_scenario("circle: {count: 8, spacing_m: 0.5}", "eight.yaml"); }

std::string placement_error(const std::string& text) {
  const Hosts hosts = parse_hosts(text, "hosts.yaml");
  try {
    (void)Placement(hosts, eight_robots());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("a hosts file assigns each process to a host") {
  const Hosts hosts = parse_hosts(kTwoHosts, "hosts.yaml");
  CHECK_FALSE(hosts.create);
  CHECK(hosts.interface == "10.1.0.9");
  REQUIRE(hosts.hosts.size() == 2);
  CHECK(hosts.hosts[1].transport == HostTransport::kSsh);
  CHECK(hosts.hosts[1].target == "robot@far.example");
  CHECK(hosts.hosts[1].programs == "/opt/sidestep/bin");
  const Scenario scenario = eight_robots();
  const Placement placement(hosts, scenario);
  for (const char* process : {"simulator", "vision", "coordinator", "agent 0", "agent 2", "agent 7"}) {
    CHECK(placement.host_of(process).name == "floor");
  }
  for (const char* process : {"agent 3", "agent 6"}) CHECK(placement.host_of(process).name == "far");
}

TEST_CASE("hosts with `rest` share the remaining processes evenly") {
  const Hosts hosts = parse_hosts(with(kTwoHosts, "[0-2, 7]", "rest"), "hosts.yaml");
  const Scenario scenario = eight_robots();
  const Placement placement(hosts, scenario);
  int on_floor = 0;
  for (const RobotSpec& robot : scenario.robots) {
    on_floor += placement.host_of("agent " + std::to_string(robot.id)).name == "floor";
  }
  CHECK(on_floor == 4);
}

TEST_CASE("an invalid hosts file is rejected with the line and the expected value") {
  check_refused("", "hosts.yaml:1: ", "expected a hosts file");
  check_refused("hosts: [", "hosts.yaml:", "not YAML");
  check_refused("hosts: []", "hosts.yaml:1: ", "\"launcher\" is missing");
  check_refused("launcher: {interface: 10.0.0.1}\nhosts: []", "hosts.yaml:2: ", "at least one host");
  check_refused(kTwoHosts + "colour: red\n", "hosts.yaml:13: ", "unknown key \"colour\"");
  check_refused(with(kTwoHosts, "    transport: local", "    colour: red\n    transport: local"),
                "hosts.yaml:4: ", "unknown key \"colour\"");
  check_refused(with(kTwoHosts, "transport: local", "transport: remote"), "hosts.yaml:4: ", "expected local");
  check_refused(with(kTwoHosts, "{ssh: robot@far.example}", "{ssh: a, namespace: b}"),
                "hosts.yaml:9: ", "one of the keys");
  check_refused(with(kTwoHosts, "{ssh: robot@far.example}", "{ssh: -oProxyCommand=x}"),
                "hosts.yaml:9: ", "expected letters");
  check_refused(with(kTwoHosts, "{ssh: robot@far.example}", "{namespace: ../x}"),
                "hosts.yaml:9: ", "expected letters");
  check_refused(with(kTwoHosts, "10.1.0.2", "far.example"), "hosts.yaml:10: ", "IPv4 address");
  // A C function would read only the part before the zero byte.
  check_refused(with(kTwoHosts, "10.1.0.2", R"("10.1.0.2\0 x")"), "hosts.yaml:10: ", "without zero bytes");
  check_refused(with(kTwoHosts, "/opt/sidestep/bin", R"("/opt\0/bin")"),
                "hosts.yaml:11: ", "without zero bytes");
  check_refused(with(kTwoHosts, "[0-2, 7]", "[2-0]"), "hosts.yaml:7: ", "lower number first");
  check_refused(with(kTwoHosts, "[0-2, 7]", "[one]"), "hosts.yaml:7: ", "a range such as 5-9");
  check_refused(with(kTwoHosts, "[0-2, 7]", "[0-4096]"), "hosts.yaml:7: ", "0 to 1023");
  check_refused(with(kTwoHosts, "vision,", "visions,"),
                "hosts.yaml:6: ", "expected simulator, robots, vision");
  check_refused(with(kTwoHosts, "name: far", "name: floor"), "hosts.yaml:8: ", "another host has this name");
  check_refused("create: true\n" + kTwoHosts, "hosts.yaml:4: ", "requires transport {namespace: NAME}");
  check_refused("create: perhaps\n" + kTwoHosts, "hosts.yaml:1: ", "true or false");
}

TEST_CASE("with `create` all addresses and namespaces must differ") {
  const std::string good =
      with(with("create: true\n" + kTwoHosts, "transport: local", "transport: {namespace: a}"),
           "{ssh: robot@far.example}", "{namespace: b}");
  CHECK(parse_hosts(good, "hosts.yaml").create);
  check_refused(with(good, "10.1.0.2", "10.1.0.1"), "hosts.yaml:9: ", "is already in use");
  check_refused(with(good, "10.1.0.2", "10.1.0.9"), "hosts.yaml:9: ", "is already in use");
  check_refused(with(good, "{namespace: b}", "{namespace: a}"),
                "hosts.yaml:9: ", "another host has this namespace");
  check_refused(with(good, "{namespace: b}", "{namespace: bridge}"),
                "hosts.yaml:9: ", "reserved for the launcher");
}

TEST_CASE("standby coordinators are placed like agents") {
  const Scenario scenario =
      parse_scenario("coordinators: 3\ncircle: {count: 8, spacing_m: 0.5}", "eight.yaml");
  const Hosts without_standbys = parse_hosts(kTwoHosts, "hosts.yaml");
  CHECK_THROWS_WITH(Placement(without_standbys, scenario),
                    StartsWith("hosts.yaml:1: no host runs coordinator 1"));
  const Hosts with_standbys =
      parse_hosts(with(kTwoHosts, "agents: rest", "agents: rest\n    standbys: [1-2]"), "hosts.yaml");
  const Placement placement(with_standbys, scenario);
  CHECK(placement.host_of("coordinator").name == "floor");
  CHECK(placement.host_of("coordinator 2").name == "far");
}

TEST_CASE("each process has exactly one host, and hosts name only existing robots") {
  CHECK(placement_error(kTwoHosts).empty());
  CHECK_THAT(placement_error(with(kTwoHosts, "vision, ", "")),
             StartsWith("hosts.yaml:1: no host runs vision"));
  CHECK_THAT(placement_error(with(kTwoHosts, "rest", "[3-5]")),
             StartsWith("hosts.yaml:1: no host runs agent 6"));
  CHECK_THAT(placement_error(with(kTwoHosts, "rest", "[2-6]")),
             StartsWith("hosts.yaml:12: host far runs agent 2, but host floor runs it already"));
  CHECK_THAT(placement_error(with(kTwoHosts, "[0-2, 7]", "[0-2, 8]")),
             StartsWith("hosts.yaml:7: host floor runs agents 8-8, but the scenario has none of them"));
}

TEST_CASE("the shipped hosts files fit any scenario") {
  const Scenario scenario = eight_robots();
  for (const char* name : {"three-namespaces", "two-machines"}) {
    const Hosts hosts =
        load_hosts(SIDESTEP_SOURCE_DIR "/deploy/run/launch/hosts/" + std::string(name) + ".yaml");
    CHECK_NOTHROW(Placement(hosts, scenario));
  }
}

TEST_CASE("peers are the addresses of the hosts, of the launcher and of the listed peers") {
  const Hosts none = parse_hosts(kTwoHosts, "hosts.yaml");
  CHECK(none.peers.empty());
  const Hosts hosts = parse_hosts("peers: hosts\n" + std::string(kTwoHosts), "hosts.yaml");
  REQUIRE(hosts.peers.size() == hosts.hosts.size() + 1);
  CHECK(hosts.peers.front() == hosts.interface);
  for (const HostSpec& host : hosts.hosts) CHECK(std::ranges::count(hosts.peers, host.interface) == 1);
  const Hosts more = parse_hosts("peers: [10.9.9.9]\n" + std::string(kTwoHosts), "hosts.yaml");
  CHECK(more.peers.size() == hosts.peers.size() + 1);
  CHECK(std::ranges::count(more.peers, "10.9.9.9") == 1);
  check_refused("peers: all\n" + std::string(kTwoHosts),
                "hosts.yaml:1: ", "expected hosts, or a list of addresses");
  check_refused("peers: [10.9.9]\n" + std::string(kTwoHosts), "hosts.yaml:1: ", "expected an IPv4 address");
}

}  // namespace sidestep::hosts_file_test
