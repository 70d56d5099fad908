// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/hosts/namespaces.hpp"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sched.h>
#include <stdexcept>
#include <unistd.h>

#include "common/file/console.hpp"
#include "deploy/run/launch/hosts/command.hpp"

namespace sidestep {
namespace {

constexpr const char* kFolder = "/run/netns";
const std::string kPrefix = "sidestep-";

std::string namespace_name(pid_t launcher, const std::string& label) {
  return fmt::format("{}{}-{}", kPrefix, launcher, label);
}

void ip(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "ip");
  run_command(arguments);
}

bool is_alive(pid_t pid) { return kill(pid, 0) == 0 || errno != ESRCH; }

}  // namespace

ScopedNamespace::ScopedNamespace(const std::string& name) {
  previous_ = open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
  const int target = open((std::string(kFolder) + "/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  const bool has_entered = target >= 0 && setns(target, CLONE_NEWNET) == 0;
  const int error = errno;
  if (target >= 0) close(target);
  if (has_entered) return;
  close(previous_);
  throw std::runtime_error(fmt::format("cannot enter network namespace {}: {}", name, std::strerror(error)));
}

ScopedNamespace::~ScopedNamespace() {
  (void)setns(previous_, CLONE_NEWNET);
  close(previous_);
}

NamespaceNetwork::NamespaceNetwork(const Hosts& hosts) {
  if (geteuid() != 0) throw std::runtime_error(hosts.file + ": creating network namespaces needs root");
  try {
    create(hosts);
  } catch (...) {
    remove();
    throw;
  }
}

NamespaceNetwork::~NamespaceNetwork() { remove(); }

std::string NamespaceNetwork::bridge() const { return full_name(kBridgeLabel); }

std::string NamespaceNetwork::full_name(const std::string& label) const {
  return namespace_name(launcher_, label);
}

void NamespaceNetwork::create(const Hosts& hosts) {
  const auto add = [this](const std::string& name) {
    created_.push_back(name);
    ip({"netns", "add", name});
    ip({"-n", name, "link", "set", "lo", "up"});
  };
  add(bridge());
  // With snooping but no querier, the bridge would soon stop forwarding the multicast of discovery.
  ip({"-n", bridge(), "link", "add", "bridge0", "type", "bridge", "mcast_snooping", "0"});
  ip({"-n", bridge(), "addr", "add", fmt::format("{}/{}", hosts.interface, hosts.prefix_length), "dev",
      "bridge0"});
  ip({"-n", bridge(), "link", "set", "bridge0", "up"});
  for (const HostSpec& host : hosts.hosts) {
    add(full_name(host.target));
    connect(host, fmt::format("cable{}", created_.size()), hosts.prefix_length);
  }
}

void NamespaceNetwork::connect(const HostSpec& host, const std::string& cable, int prefix_length) {
  const std::string name = full_name(host.target);
  ip({"link", "add", "eth0", "netns", name, "type", "veth", "peer", "name", cable, "netns", bridge()});
  ip({"-n", bridge(), "link", "set", cable, "master", "bridge0", "up"});
  ip({"-n", name, "addr", "add", fmt::format("{}/{}", host.interface, prefix_length), "dev", "eth0"});
  ip({"-n", name, "link", "set", "eth0", "up"});
}

void NamespaceNetwork::remove() {
  for (const std::string& name : created_) {
    if (!std::filesystem::exists(std::string(kFolder) + "/" + name)) continue;
    try {
      ip({"netns", "del", name});
    } catch (const std::exception& error) {
      print_to(stderr, "sidestep: {}\n", error.what());
    }
  }
  created_.clear();
}

std::vector<RunNamespace> run_namespaces() {
  std::vector<RunNamespace> result;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder, none)) {
    RunNamespace found;
    found.name = entry.path().filename().string();
    if (!found.name.starts_with(kPrefix)) continue;
    const char* const begin = found.name.data() + kPrefix.size();
    const char* const end = found.name.data() + found.name.size();
    const auto [stop, error] = std::from_chars(begin, end, found.launcher);
    if (error != std::errc{} || found.launcher <= 0 || stop == end || *stop != '-') continue;
    found.label.assign(stop + 1, end);
    result.push_back(found);
  }
  return result;
}

void remove_abandoned_namespaces() {
  for (const RunNamespace& found : run_namespaces()) {
    if (is_alive(found.launcher)) continue;
    try {
      ip({"netns", "del", found.name});
    } catch (const std::exception&) {
      // Another launcher may have removed it in the meantime.
    }
  }
}

}  // namespace sidestep
