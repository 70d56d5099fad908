// SPDX-License-Identifier: Apache-2.0
// Fuzzes hosts files and the placement of a scenario's processes on
// hosts.
#include <algorithm>
#include <arpa/inet.h>
#include <set>

#include "common/config/scenario_loader.hpp"
#include "common/motion/version.hpp"
#include "deploy/run/launch/hosts/placement.hpp"
#include "tests/fuzz/fuzz_target.hpp"

namespace sidestep::fuzz {
namespace {

constexpr const char* kFile = "fuzz.yaml";

/// Addresses must be real addresses, because they become arguments of other programs.
void check_address(const std::string& text) {
  in_addr address{};
  SIDESTEP_REQUIRE(inet_pton(AF_INET, text.c_str(), &address) == 1);
  char plain[INET_ADDRSTRLEN] = {};
  SIDESTEP_REQUIRE(inet_ntop(AF_INET, &address, plain, sizeof plain) != nullptr);
  SIDESTEP_REQUIRE(text == plain);
}

/// Names must not look like options, and contain no spaces and no characters that a shell interprets.
void check_name(const std::string& text, std::string_view extra) {
  SIDESTEP_REQUIRE(!text.empty() && text[0] != '-');
  for (const char c : text) {
    SIDESTEP_REQUIRE((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                     extra.find(c) != std::string_view::npos);
  }
}

void check(const NumberedShare& share) {
  for (const NumberedShare::Range& range : share.ranges)
    SIDESTEP_REQUIRE(range.first <= range.last && range.last < kMaxRobots && range.line >= 1);
}

void check(const HostSpec& host) {
  check_name(host.name, "-_");
  check_address(host.interface);
  if (host.transport == HostTransport::kLocal)
    SIDESTEP_REQUIRE(host.target.empty());
  else
    check_name(host.target, "-_.@");
  SIDESTEP_REQUIRE(host.programs.empty() || host.programs[0] == '/');
  SIDESTEP_REQUIRE(host.programs.find('\0') == std::string::npos);
  check(host.standbys);
  check(host.agents);
}

void check(const Hosts& hosts) {
  SIDESTEP_REQUIRE(!hosts.hosts.empty() && hosts.hosts.size() <= 100);
  SIDESTEP_REQUIRE(hosts.prefix_length >= 8 && hosts.prefix_length <= 30);
  check_address(hosts.interface);
  std::ranges::for_each(hosts.peers, check_address);
  std::set<std::string> names;
  for (const HostSpec& host : hosts.hosts) {
    check(host);
    SIDESTEP_REQUIRE(names.insert(host.name).second);
    SIDESTEP_REQUIRE(!hosts.create || host.transport == HostTransport::kNamespace);
    SIDESTEP_REQUIRE(hosts.peers.empty() ||
                     std::ranges::find(hosts.peers, host.interface) != hosts.peers.end());
  }
}

void check_error(const ConfigError& error) {
  SIDESTEP_REQUIRE(std::string_view(error.what()).starts_with("fuzz.yaml:"));
}

void try_placement(const Hosts& hosts) {
  static const Scenario scenario = parse_scenario(
      "coordinators: 3\nrobots:\n  - {id: 0, start_m: [-2, 0]}\n  - {id: 1, start_m: [2, 1]}\n", "two.yaml");
  try {
    const Placement placement(hosts, scenario);
    for (const char* process : {"simulator", "vision", "coordinator", "agent 0", "agent 1"}) {
      const HostSpec& host = placement.host_of(process);
      SIDESTEP_REQUIRE(&host >= hosts.hosts.data() && &host < hosts.hosts.data() + hosts.hosts.size());
    }
  } catch (const ConfigError& error) {
    check_error(error);
  }
}

}  // namespace

bool try_input(View input) {
  try {
    const Hosts hosts = parse_hosts(text_of(input), kFile);
    check(hosts);
    try_placement(hosts);
    return true;
  } catch (const ConfigError& error) {
    check_error(error);
    return false;
  }
}

std::vector<Bytes> seeds() {
  std::vector<Bytes> result;
  for (const auto& file : files_in("deploy/run/launch/hosts", ".yaml")) result.push_back(file_content(file));
  result.push_back(bytes_of(R"(launcher: {interface: 10.0.0.1}
peers: [10.0.0.9]
prefix_length: 16
hosts:
  - {name: a, transport: local, interface: "10.0.0.1", processes: [simulator, vision], agents: 0-1}
  - {name: b, transport: {ssh: robot@b}, interface: 10.0.0.2, programs: /opt/bin, processes: [coordinator],
     standbys: [1, 2-3]}
)"));
  return result;
}

}  // namespace sidestep::fuzz
