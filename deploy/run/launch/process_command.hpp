// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/time/time.hpp"
#include "deploy/run/launch/hosts/hosts_file.hpp"
#include "deploy/run/launch/processes.hpp"

namespace sidestep {

/// A Sidestep program and its arguments.
struct ProcessSpec {
  std::string name;     ///< for example "agent 3"
  std::string program;  ///< for example "sidestep-agent"
  std::string scenario_file;
  int domain = 0;
  std::vector<std::string> arguments;  ///< in addition to scenario, domain and interface
  bool restart = false;
  std::vector<std::string> peers{};  ///< see DdsSettings::peers
  std::string keys{};                ///< see DdsSettings::keys; a folder on this machine
  bool insecure = false;             ///< see DdsSettings::insecure
  /// Maximum time for its robots to come to rest when it is asked to end; see ChildSpec::rest_time.
  Duration rest_time{0};
};

/// The child process that runs the program on a host: the program itself, `ip netns exec` for the namespace
/// `namespace_name`, or ssh. Over ssh, the scenario and the keys are sent along, and the remote process ends
/// with the connection. Throws std::runtime_error when ip or ssh is missing, or a file cannot be read.
[[nodiscard]] ChildSpec child_spec(const ProcessSpec& process, const HostSpec& host,
                                   const std::string& namespace_name);

/// Input for the stdin of a process over ssh that adds or replaces a file in the process's folder of scenario
/// and keys.
[[nodiscard]] std::string file_input(const std::string& name, const std::string& content);

/// Reads a file of a key folder. Throws std::runtime_error if the file cannot be read.
[[nodiscard]] std::string read_key_file(const std::string& folder, const char* name);

}  // namespace sidestep
