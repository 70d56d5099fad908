// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/namespaces.hpp"

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

#include "deploy/launch/hosts/command.hpp"

namespace sidestep {
namespace {

constexpr const char* kFolder = "/run/netns";
const std::string kPrefix = "sidestep-";

std::string full_name(pid_t launcher, const std::string& called) {
  return fmt::format("{}{}-{}", kPrefix, launcher, called);
}

void ip(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "ip");
  run_command(arguments);
}

bool lives(pid_t pid) { return kill(pid, 0) == 0 || errno != ESRCH; }

}  // namespace

NamespaceVisit::NamespaceVisit(const std::string& name) {
  before_ = open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
  const int there = open((std::string(kFolder) + "/" + name).c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_in = there >= 0 && setns(there, CLONE_NEWNET) == 0;
  const int error = errno;
  if (there >= 0) close(there);
  if (is_in) return;
  close(before_);
  throw std::runtime_error(fmt::format("cannot enter network namespace {}: {}", name, std::strerror(error)));
}

NamespaceVisit::~NamespaceVisit() {
  (void)setns(before_, CLONE_NEWNET);
  close(before_);
}

NamespaceNetwork::NamespaceNetwork(const Hosts& hosts) {
  if (geteuid() != 0) throw std::runtime_error(hosts.file + ": making network namespaces needs root");
  try {
    make(hosts);
  } catch (...) {
    remove();
    throw;
  }
}

NamespaceNetwork::~NamespaceNetwork() { remove(); }

std::string NamespaceNetwork::hub() const { return name_of(kHubName); }

std::string NamespaceNetwork::name_of(const std::string& name) const { return full_name(getpid(), name); }

void NamespaceNetwork::make(const Hosts& hosts) {
  const auto add = [this](const std::string& name) {
    made_.push_back(name);
    ip({"netns", "add", name});
    ip({"-n", name, "link", "set", "lo", "up"});
  };
  add(hub());
  // Without a querier, a bridge that snoops soon forgets who listens to the multicast of discovery.
  ip({"-n", hub(), "link", "add", "bridge0", "type", "bridge", "mcast_snooping", "0"});
  ip({"-n", hub(), "addr", "add", fmt::format("{}/{}", hosts.interface, hosts.prefix_length), "dev",
      "bridge0"});
  ip({"-n", hub(), "link", "set", "bridge0", "up"});
  for (const HostSpec& host : hosts.hosts) {
    add(name_of(host.target));
    connect(host, fmt::format("cable{}", made_.size()), hosts.prefix_length);
  }
}

void NamespaceNetwork::connect(const HostSpec& host, const std::string& cable, int prefix_length) {
  const std::string name = name_of(host.target);
  ip({"link", "add", "eth0", "netns", name, "type", "veth", "peer", "name", cable, "netns", hub()});
  ip({"-n", hub(), "link", "set", cable, "master", "bridge0", "up"});
  ip({"-n", name, "addr", "add", fmt::format("{}/{}", host.interface, prefix_length), "dev", "eth0"});
  ip({"-n", name, "link", "set", "eth0", "up"});
}

void NamespaceNetwork::remove() {
  for (const std::string& name : made_) {
    if (!std::filesystem::exists(std::string(kFolder) + "/" + name)) continue;
    try {
      ip({"netns", "del", name});
    } catch (const std::exception& error) {
      fmt::print(stderr, "sidestep: {}\n", error.what());
    }
  }
  made_.clear();
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
    found.called.assign(stop + 1, end);
    result.push_back(found);
  }
  return result;
}

void remove_abandoned_namespaces() {
  for (const RunNamespace& found : run_namespaces()) {
    if (lives(found.launcher)) continue;
    try {
      ip({"netns", "del", found.name});
    } catch (const std::exception&) {
      // Another launcher that starts just now has been faster.
    }
  }
}

}  // namespace sidestep
