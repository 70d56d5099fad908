// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/time/time.hpp"
#include "deploy/launch/hosts/hosts_file.hpp"
#include "deploy/launch/processes.hpp"

namespace sidestep {

/// A Sidestep program and its arguments.
struct ProcessSpec {
  std::string name;     ///< e.g. "agent 3"
  std::string program;  ///< e.g. "sidestep-agent"
  std::string scenario_file;
  int domain = 0;
  std::vector<std::string> arguments;  ///< besides scenario, domain and interface
  bool restart = false;
  std::vector<std::string> peers{};  ///< as DdsSettings::peers
  std::string keys{};                ///< as DdsSettings::keys, on this machine
  bool insecure = false;             ///< as DdsSettings::insecure
  Duration rest_time{0};             ///< as ChildSpec::rest_time
};

/// The child process that runs the program on a host: the program itself, `ip netns exec` for the namespace
/// `namespace_name`, or ssh. Over ssh the scenario and the keys travel along, and the remote process ends
/// with the connection. Throws std::runtime_error when ip or ssh is missing, or a file cannot be read.
[[nodiscard]] ChildSpec child_spec(const ProcessSpec& process, const HostSpec& host,
                                   const std::string& namespace_name);

/// What to send to the stdin of a process over ssh, so that it gets a file in the folder of its scenario and
/// keys, or one is replaced there.
[[nodiscard]] std::string file_input(const std::string& name, const std::string& content);

/// Throws std::runtime_error if the file cannot be read.
[[nodiscard]] std::string read_key_file(const std::string& folder, const char* name);

}  // namespace sidestep
