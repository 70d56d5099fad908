// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/fault/link_filter.hpp"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <stdexcept>
#include <unistd.h>

#include "deploy/run/launch/hosts/command.hpp"
#include "deploy/run/launch/hosts/namespaces.hpp"

namespace sidestep {
namespace {

constexpr int kResolution = 10000;  ///< resolution of a probability

void nft(const std::string& namespace_name, const std::string& rules) {
  run_command({"ip", "netns", "exec", namespace_name, "nft", "-f", "-"}, rules);
}

std::string drop_rule(double loss) {
  if (loss >= 1) return "drop";
  return fmt::format("numgen random mod {} < {} drop", kResolution, std::lround(loss * kResolution));
}

/// nft can add an existing table, but cannot delete a missing one.
const std::string kDeleteTable = "add table inet sidestep_fault\ndelete table inet sidestep_fault\n";

}  // namespace

std::vector<std::string> namespaces_of_host(const std::string& host) {
  if (geteuid() != 0) throw std::runtime_error("filtering packets of a host needs root");
  if (host.find('/') == std::string::npos && std::filesystem::exists("/run/netns/" + host)) return {host};
  std::vector<std::string> found;
  std::set<std::string> known;
  std::set<pid_t> launchers;
  remove_abandoned_namespaces();
  for (const RunNamespace& one : run_namespaces()) {
    if (one.label == kBridgeLabel) continue;
    known.insert(one.label);
    if (one.label != host && host != "all") continue;
    found.push_back(one.name);
    launchers.insert(one.launcher);
  }
  if (known.empty()) {
    throw std::runtime_error(
        "no run on this machine has namespace hosts; disconnect real hosts on those machines");
  }
  if (found.empty())
    throw std::runtime_error(fmt::format("no host {}, expected one of: {}", host, fmt::join(known, ", ")));
  if (launchers.size() > 1) {
    throw std::runtime_error(
        fmt::format("several runs have a host {}, expected one of: {}", host, fmt::join(found, ", ")));
  }
  return found;
}

void set_link_fault(const std::string& namespace_name, const LinkFault& fault) {
  std::string rules = kDeleteTable + "table inet sidestep_fault {\n";
  const auto chain = [&](const char* name, const char* hook, const std::string& rule) {
    rules += fmt::format("chain {} {{ type filter hook {} priority 0; {}; }}\n", name, hook, rule);
  };
  if (fault.loss_in > 0) chain("input", "input", "iifname != \"lo\" " + drop_rule(fault.loss_in));
  if (fault.loss_out > 0) chain("output", "output", "oifname != \"lo\" " + drop_rule(fault.loss_out));
  if (!fault.cut_from.empty())
    chain("cut", "input", fmt::format("ip saddr {{ {} }} drop", fmt::join(fault.cut_from, ", ")));
  nft(namespace_name, rules + "}\n");
}

void clear_link_fault(const std::string& namespace_name) { nft(namespace_name, kDeleteTable); }

}  // namespace sidestep
