// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/hosts/hosts_file.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <fmt/format.h>
#include <set>

#include "common/motion/version.hpp"
#include "common/yaml/yaml_document.hpp"
#include "common/yaml/yaml_map.hpp"
#include "deploy/run/launch/hosts/namespaces.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a hosts file";
constexpr std::size_t kMaxHosts = 100;
constexpr std::size_t kMaxNameLength = 24;
constexpr std::uint32_t kMaxNumber = kMaxRobots - 1;

std::string identifier_from(const YAML::Node& node, const YamlLocation& location,
                            const std::string& extra_characters) {
  std::string text = text_from(node, location);
  const auto is_plain = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           extra_characters.find(c) != std::string::npos;
  };
  if (text.empty() || text[0] == '-' || text[0] == '.' || !std::all_of(text.begin(), text.end(), is_plain)) {
    location.fail(fmt::format("expected letters, digits and any of \"{}\", got \"{}\"", extra_characters,
                              text.substr(0, 40)));
  }
  return text;
}

std::string name_from(const YAML::Node& node, const YamlLocation& location) {
  std::string name = identifier_from(node, location, "-_");
  if (name.size() > kMaxNameLength)
    location.fail(fmt::format("expected at most {} characters", kMaxNameLength));
  return name;
}

std::string address_from(const YAML::Node& node, const YamlLocation& location) {
  std::string text = text_from(node, location);
  in_addr parsed{};
  if (inet_pton(AF_INET, text.c_str(), &parsed) != 1) {
    location.fail(fmt::format("expected an IPv4 address, got \"{}\"", text.substr(0, 40)));
  }
  return text;
}

bool flag_from(const YAML::Node& node, const YamlLocation& location) {
  const std::string text = text_from(node, location);
  if (text != "true" && text != "false") location.fail("expected true or false");
  return text == "true";
}

/// Reads a range: "3" or "5-9".
NumberedShare::Range range_from(const YAML::Node& node, const YamlLocation& location) {
  const std::string text = text_from(node, location);
  const auto dash = text.find('-');
  const auto number = [&](const std::string& digits) {
    const bool is_number =
        !digits.empty() && digits.size() <= 4 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number || std::stoul(digits) > kMaxNumber) {
      location.fail(fmt::format("expected a number from 0 to {} or a range such as 5-9, got \"{}\"",
                                kMaxNumber, text.substr(0, 40)));
    }
    return static_cast<std::uint32_t>(std::stoul(digits));
  };
  NumberedShare::Range range{0, 0, location.line};
  range.first = number(text.substr(0, dash));
  range.last = dash == std::string::npos ? range.first : number(text.substr(dash + 1));
  if (range.last < range.first) location.fail("expected the lower number first, got " + text);
  return range;
}

void read_share(YamlMap& map, const std::string& key, NumberedShare& share) {
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return;
  const YamlLocation location = map.location_of(key);
  if (node.IsScalar()) {
    if (node.Scalar() == "rest") {
      share.rest = true;
    } else {
      share.ranges.push_back(range_from(node, location));
    }
    return;
  }
  for (const YAML::Node& element : list_from(node, location, kMaxRobots)) {
    share.ranges.push_back(range_from(element, location.of(element, location.what)));
  }
}

void read_transport(YamlMap& map, HostSpec& host) {
  const YAML::Node node = map.require("transport");
  const YamlLocation location = map.location_of("transport");
  if (node.IsScalar()) {
    if (node.Scalar() != "local") location.fail("expected local, {namespace: NAME} or {ssh: USER@HOST}");
    return;
  }
  YamlMap inner(node, location);
  const YAML::Node name = inner.find("namespace"), remote = inner.find("ssh");
  inner.finish();
  if (name.IsDefined() == remote.IsDefined()) location.fail("expected one of the keys namespace and ssh");
  if (name.IsDefined()) {
    host.transport = HostTransport::kNamespace;
    host.target = name_from(name, inner.location_of("namespace"));
  } else {
    host.transport = HostTransport::kSsh;
    host.target = identifier_from(remote, inner.location_of("ssh"), "-_.@");
  }
}

void read_processes(YamlMap& map, HostSpec& host) {
  const YAML::Node node = map.find("processes");
  if (!node.IsDefined()) return;
  const YamlLocation location = map.location_of("processes");
  for (const YAML::Node& element : list_from(node, location, 16)) {
    const YamlLocation element_location = location.of(element, location.what);
    const std::string process = text_from(element, element_location);
    bool* const flag = process == "simulator"     ? &host.simulator
                       : process == "robots"      ? &host.robots
                       : process == "vision"      ? &host.vision
                       : process == "coordinator" ? &host.coordinator
                                                  : nullptr;
    if (!flag)
      element_location.fail("expected simulator, robots, vision or coordinator, got \"" +
                            process.substr(0, 40) + "\"");
    *flag = true;
  }
}

HostSpec read_host(const YAML::Node& node, const YamlLocation& location) {
  YamlMap map(node, location);
  HostSpec host;
  host.line = location.line;
  host.name = name_from(map.require("name"), map.location_of("name"));
  read_transport(map, host);
  host.interface = address_from(map.require("interface"), map.location_of("interface"));
  if (const YAML::Node folder = map.find("programs"); folder.IsDefined()) {
    host.programs = text_from(folder, map.location_of("programs"));
    if (host.programs.empty() || host.programs[0] != '/')
      map.location_of("programs").fail("expected an absolute path");
  }
  read_processes(map, host);
  read_share(map, "standbys", host.standbys);
  read_share(map, "agents", host.agents);
  map.finish();
  return host;
}

/// Reads `peers: hosts`, or a list of addresses in addition to those of the hosts.
void read_peers(YamlMap& map, Hosts& hosts) {
  const YAML::Node node = map.find("peers");
  if (!node.IsDefined()) return;
  const YamlLocation location = map.location_of("peers");
  hosts.peers.push_back(hosts.interface);
  if (node.IsScalar()) {
    if (node.Scalar() != "hosts")
      location.fail("expected hosts, or a list of addresses besides those of the hosts");
    return;
  }
  for (const YAML::Node& element : list_from(node, location, kMaxHosts))
    hosts.peers.push_back(address_from(element, location.of(element, location.what)));
}

void add_own_peers(Hosts& hosts) {
  if (hosts.peers.empty()) return;
  for (const HostSpec& host : hosts.hosts) {
    if (std::ranges::find(hosts.peers, host.interface) == hosts.peers.end())
      hosts.peers.push_back(host.interface);
  }
}

void check_unique(const Hosts& hosts) {
  std::set<std::string> names, addresses, targets;
  if (hosts.create) addresses.insert(hosts.interface);
  for (const HostSpec& host : hosts.hosts) {
    const YamlLocation location{hosts.file, host.line, "host " + host.name};
    if (!names.insert(host.name).second) location.fail("another host has this name");
    if (!hosts.create) continue;
    if (host.transport != HostTransport::kNamespace)
      location.fail("create: true requires transport {namespace: NAME}");
    if (!addresses.insert(host.interface).second)
      location.fail("the interface " + host.interface + " is already in use");
    if (host.target == kBridgeLabel)
      location.fail("this namespace is reserved for the launcher, expected another name");
    if (!targets.insert(host.target).second) location.fail("another host has this namespace");
  }
}

}  // namespace

Hosts parse_hosts(const std::string& text, const std::string& file_name) {
  const YAML::Node root = parse_yaml(text, file_name, kExpected);
  const YamlLocation root_location{file_name, 1, ""};
  YamlMap map(root, root_location.of(root, ""));
  Hosts result;
  result.file = file_name;
  if (const YAML::Node create = map.find("create"); create.IsDefined())
    result.create = flag_from(create, map.location_of("create"));
  YamlMap launcher(map.require("launcher"), map.location_of("launcher"));
  result.interface = address_from(launcher.require("interface"), launcher.location_of("interface"));
  launcher.finish();
  map.read("prefix_length", {8, 30}, result.prefix_length);
  read_peers(map, result);
  const YamlLocation location = map.location_of("hosts");
  for (const YAML::Node& element : list_from(map.require("hosts"), location, kMaxHosts)) {
    result.hosts.push_back(
        read_host(element, location.of(element, fmt::format("hosts[{}]", result.hosts.size()))));
  }
  map.finish();
  if (result.hosts.empty()) location.fail("expected at least one host");
  add_own_peers(result);
  check_unique(result);
  return result;
}

Hosts load_hosts(const std::string& path) { return parse_hosts(read_yaml_file(path, kExpected), path); }

Hosts local_hosts(const std::string& interface) {
  HostSpec local;
  local.name = "local";
  local.interface = interface;
  local.simulator = local.robots = local.vision = local.coordinator = true;
  local.standbys.rest = local.agents.rest = true;
  Hosts result;
  result.interface = interface;
  result.hosts.push_back(local);
  return result;
}

}  // namespace sidestep
