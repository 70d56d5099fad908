// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/hosts_file.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <fmt/format.h>
#include <set>

#include "common/config/yaml_document.hpp"
#include "common/config/yaml_map.hpp"
#include "common/motion/version.hpp"
#include "deploy/launch/hosts/namespaces.hpp"

namespace sidestep {
namespace {

constexpr const char* kExpected = "a hosts file";
constexpr std::size_t kMaxHosts = 100;
constexpr std::size_t kMaxName = 24;
constexpr std::uint32_t kMaxNumber = kMaxRobots - 1;

std::string word_from(const YAML::Node& node, const YamlPlace& place, const std::string& more_letters) {
  const std::string text = text_from(node, place);
  const auto is_plain = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           more_letters.find(c) != std::string::npos;
  };
  if (text.empty() || text[0] == '-' || text[0] == '.' || !std::all_of(text.begin(), text.end(), is_plain)) {
    place.refuse(fmt::format("expected letters, digits and any of \"{}\", got \"{}\"", more_letters,
                             text.substr(0, 40)));
  }
  return text;
}

std::string name_from(const YAML::Node& node, const YamlPlace& place) {
  const std::string name = word_from(node, place, "-_");
  if (name.size() > kMaxName) place.refuse(fmt::format("expected at most {} letters", kMaxName));
  return name;
}

std::string address_from(const YAML::Node& node, const YamlPlace& place) {
  const std::string text = text_from(node, place);
  in_addr parsed{};
  if (inet_pton(AF_INET, text.c_str(), &parsed) != 1) {
    place.refuse(fmt::format("expected an IPv4 address, got \"{}\"", text.substr(0, 40)));
  }
  return text;
}

bool flag_from(const YAML::Node& node, const YamlPlace& place) {
  const std::string text = text_from(node, place);
  if (text != "true" && text != "false") place.refuse("expected true or false");
  return text == "true";
}

/// "3" or "5-9"
NumberedShare::Range range_from(const YAML::Node& node, const YamlPlace& place) {
  const std::string text = text_from(node, place);
  const auto dash = text.find('-');
  const auto number = [&](const std::string& digits) {
    const bool is_number =
        !digits.empty() && digits.size() <= 4 && digits.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number || std::stoul(digits) > kMaxNumber) {
      place.refuse(fmt::format("expected numbers of 0 to {} such as 3 or 5-9, got \"{}\"", kMaxNumber,
                               text.substr(0, 40)));
    }
    return static_cast<std::uint32_t>(std::stoul(digits));
  };
  NumberedShare::Range range{0, 0, place.line};
  range.first = number(text.substr(0, dash));
  range.last = dash == std::string::npos ? range.first : number(text.substr(dash + 1));
  if (range.last < range.first) place.refuse("expected the lower number first, got " + text);
  return range;
}

void read_share(YamlMap& map, const std::string& key, NumberedShare& share) {
  const YAML::Node node = map.find(key);
  if (!node.IsDefined()) return;
  const YamlPlace place = map.place_of(key);
  if (node.IsScalar()) {
    if (node.Scalar() == "rest") {
      share.rest = true;
    } else {
      share.ranges.push_back(range_from(node, place));
    }
    return;
  }
  for (const YAML::Node& element : list_from(node, place, kMaxRobots)) {
    share.ranges.push_back(range_from(element, place.of(element, place.what)));
  }
}

void read_transport(YamlMap& map, HostSpec& host) {
  const YAML::Node node = map.require("transport");
  const YamlPlace place = map.place_of("transport");
  if (node.IsScalar()) {
    if (node.Scalar() != "local") place.refuse("expected local, {namespace: NAME} or {ssh: USER@HOST}");
    return;
  }
  YamlMap inner(node, place);
  const YAML::Node name = inner.find("namespace"), remote = inner.find("ssh");
  inner.finish();
  if (name.IsDefined() == remote.IsDefined()) place.refuse("expected one of the keys namespace and ssh");
  if (name.IsDefined()) {
    host.transport = HostTransport::kNamespace;
    host.target = name_from(name, inner.place_of("namespace"));
  } else {
    host.transport = HostTransport::kSsh;
    host.target = word_from(remote, inner.place_of("ssh"), "-_.@");
  }
}

void read_processes(YamlMap& map, HostSpec& host) {
  const YAML::Node node = map.find("processes");
  if (!node.IsDefined()) return;
  const YamlPlace place = map.place_of("processes");
  for (const YAML::Node& element : list_from(node, place, 16)) {
    const YamlPlace here = place.of(element, place.what);
    const std::string process = text_from(element, here);
    bool* const flag = process == "simulator"     ? &host.simulator
                       : process == "vision"      ? &host.vision
                       : process == "coordinator" ? &host.coordinator
                                                  : nullptr;
    if (!flag)
      here.refuse("expected simulator, vision or coordinator, got \"" + process.substr(0, 40) + "\"");
    *flag = true;
  }
}

HostSpec read_host(const YAML::Node& node, const YamlPlace& place) {
  YamlMap map(node, place);
  HostSpec host;
  host.line = place.line;
  host.name = name_from(map.require("name"), map.place_of("name"));
  read_transport(map, host);
  host.interface = address_from(map.require("interface"), map.place_of("interface"));
  if (const YAML::Node folder = map.find("programs"); folder.IsDefined()) {
    host.programs = text_from(folder, map.place_of("programs"));
    if (host.programs.empty() || host.programs[0] != '/')
      map.place_of("programs").refuse("expected a folder that begins with /");
  }
  read_processes(map, host);
  read_share(map, "standbys", host.standbys);
  read_share(map, "agents", host.agents);
  map.finish();
  return host;
}

void check_differences(const Hosts& hosts) {
  std::set<std::string> names, addresses, targets;
  if (hosts.create) addresses.insert(hosts.interface);
  for (const HostSpec& host : hosts.hosts) {
    const YamlPlace place{hosts.file, host.line, "host " + host.name};
    if (!names.insert(host.name).second) place.refuse("another host has this name");
    if (!hosts.create) continue;
    if (host.transport != HostTransport::kNamespace)
      place.refuse("create: true is for namespaces only, expected transport {namespace: NAME}");
    if (!addresses.insert(host.interface).second)
      place.refuse("its interface " + host.interface + " is already somebody else's");
    if (host.target == kHubName) place.refuse("this namespace is the launcher's own, expected another name");
    if (!targets.insert(host.target).second) place.refuse("another host has this namespace");
  }
}

}  // namespace

Hosts parse_hosts(const std::string& text, const std::string& file_name) {
  const YAML::Node root = parse_yaml(text, file_name, kExpected);
  const YamlPlace whole{file_name, 1, ""};
  YamlMap map(root, whole.of(root, ""));
  Hosts result;
  result.file = file_name;
  if (const YAML::Node create = map.find("create"); create.IsDefined())
    result.create = flag_from(create, map.place_of("create"));
  YamlMap launcher(map.require("launcher"), map.place_of("launcher"));
  result.interface = address_from(launcher.require("interface"), launcher.place_of("interface"));
  launcher.finish();
  map.read("prefix_length", {8, 30}, result.prefix_length);
  const YamlPlace place = map.place_of("hosts");
  for (const YAML::Node& element : list_from(map.require("hosts"), place, kMaxHosts)) {
    result.hosts.push_back(
        read_host(element, place.of(element, fmt::format("hosts[{}]", result.hosts.size()))));
  }
  map.finish();
  if (result.hosts.empty()) place.refuse("expected at least one host");
  check_differences(result);
  return result;
}

Hosts load_hosts(const std::string& path) { return parse_hosts(read_yaml_file(path, kExpected), path); }

Hosts local_hosts(const std::string& interface) {
  HostSpec here;
  here.name = "here";
  here.interface = interface;
  here.simulator = here.vision = here.coordinator = true;
  here.standbys.rest = here.agents.rest = true;
  Hosts result;
  result.interface = interface;
  result.hosts.push_back(here);
  return result;
}

}  // namespace sidestep
