// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "deploy/launch/hosts/hosts_file.hpp"
#include "deploy/launch/process_group.hpp"

namespace sidestep {

/// One of our programs as it is to be started somewhere.
struct ProcessCall {
  std::string name;     ///< e.g. "agent 3"
  std::string program;  ///< e.g. "sidestep-agent"
  std::string scenario_file;
  int domain = 0;
  std::vector<std::string> more;  ///< arguments
  bool restart = false;
};

/// How to start it on a host: directly, in the network namespace `namespace_name`, or by ssh, which carries
/// the scenario along and ends the process there when the connection ends. Throws std::runtime_error when the
/// program for that is missing or the scenario cannot be read.
ChildSpec child_on_host(const ProcessCall& call, const HostSpec& host, const std::string& namespace_name);

}  // namespace sidestep
