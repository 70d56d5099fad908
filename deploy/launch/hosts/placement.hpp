// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "common/config/scenario.hpp"
#include "deploy/launch/hosts/hosts_file.hpp"

namespace sidestep {

/// Which host each process of a scenario runs on.
class Placement {
 public:
  /// Throws ScenarioError with the hosts file's line when a process has no host or two, or a host names
  /// robots that there are not. The hosts must outlive the placement.
  Placement(const Hosts& hosts, const Scenario& scenario);

  /// `process` by the name that everybody knows it by: "simulator", "agent 3".
  const HostSpec& host_of(const std::string& process) const { return *hosts_of_.at(process); }

 private:
  void place(const std::string& process, const HostSpec& host, int line);
  void place_single(const std::string& process, bool HostSpec::*flag);
  /// `names` by number: those that the hosts may name.
  void place_numbered(const std::map<std::uint32_t, std::string>& names, NumberedShare HostSpec::*share,
                      const std::string& key);

  const Hosts& hosts_;
  std::map<std::string, const HostSpec*> hosts_of_;
};

}  // namespace sidestep
