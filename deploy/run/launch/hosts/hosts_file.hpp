// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

enum class HostTransport { kLocal, kNamespace, kSsh };

/// The numbered processes of one kind that run on a host.
struct NumberedShare {
  struct Range {
    std::uint32_t first, last;
    int line;  ///< line number in the hosts file
  };
  std::vector<Range> ranges;
  bool rest = false;  ///< takes an even share of the processes that no host lists
};

/// A host (a machine or a network namespace) and the processes that run there.
struct HostSpec {
  std::string name;
  int line = 0;  ///< line number in the hosts file
  HostTransport transport = HostTransport::kLocal;
  std::string target;     ///< the namespace, or user@host for ssh
  std::string interface;  ///< the host's address in the hosts' network
  std::string programs;   ///< folder of the Sidestep programs on the host; empty: the launcher's folder
  bool simulator = false, robots = false, vision = false, coordinator = false;
  NumberedShare standbys, agents;
};

/// The content of a hosts file (deploy/run/launch/README.md).
struct Hosts {
  std::string file;
  bool create = false;     ///< the launcher creates and removes the namespaces and their network
  std::string interface;   ///< the launcher's address in the hosts' network
  int prefix_length = 24;  ///< prefix length of all addresses, if the launcher creates the network
  /// Addresses at which processes look for each other; empty: they find each other by multicast.
  std::vector<std::string> peers;
  std::vector<HostSpec> hosts;
};

/// Reads and checks a hosts file; throws ConfigError ("FILE:LINE: ...") for any error.
[[nodiscard]] Hosts load_hosts(const std::string& path);
/// Parses the text of a hosts file; `file_name` appears in error messages.
[[nodiscard]] Hosts parse_hosts(const std::string& text, const std::string& file_name);
/// Hosts with all processes on this machine.
Hosts local_hosts(const std::string& interface);

}  // namespace sidestep
