// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "common/config/scenario.hpp"
#include "deploy/run/launch/hosts/hosts_file.hpp"

namespace sidestep {

/// The host of each process of a scenario.
class Placement {
 public:
  /// Throws ConfigError with the line of the hosts file if a process has no host or more than one, or a host
  /// names processes that the scenario does not have. The hosts must outlive the placement. `has_driver`
  /// means that sidestep-robot runs instead of the simulator.
  Placement(const Hosts& hosts, const Scenario& scenario, bool has_driver = false);

  /// `process` is for example "simulator" or "agent 3" (common/protocol/process_names.hpp).
  const HostSpec& host_of(const std::string& process) const { return *host_by_process_.at(process); }

 private:
  void place(const std::string& process, const HostSpec& host, int line);
  void place_single(const std::string& process, bool HostSpec::*flag);
  /// Places the numbered processes of one kind. `names`: the scenario's processes of this kind, by number.
  void place_numbered(const std::map<std::uint32_t, std::string>& names, NumberedShare HostSpec::*share,
                      const std::string& key);

  const Hosts& hosts_;
  std::map<std::string, const HostSpec*> host_by_process_;
};

}  // namespace sidestep
