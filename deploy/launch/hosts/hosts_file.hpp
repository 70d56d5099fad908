// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace sidestep {

enum class HostTransport { kLocal, kNamespace, kSsh };

/// Which of several processes of one kind run on a host.
struct NumberedShare {
  struct Range {
    std::uint32_t first, last;
    int line;  ///< of the hosts file
  };
  std::vector<Range> ranges;
  bool rest = false;  ///< its share of those that no host names
};

/// A machine, or what stands for one, and the processes that run there.
struct HostSpec {
  std::string name;
  int line = 0;  ///< of the hosts file
  HostTransport transport = HostTransport::kLocal;
  std::string target;     ///< of the transport: the namespace, or user@host
  std::string interface;  ///< its address in the network that connects the hosts
  std::string programs;   ///< folder that holds our programs there; empty: the launcher's own
  bool simulator = false, vision = false, coordinator = false;
  NumberedShare standbys, agents;
};

/// Where the processes of a run go (deploy/launch/hosts/README.md).
struct Hosts {
  std::string file;
  bool create = false;     ///< the launcher makes the namespaces and their network, and removes them
  std::string interface;   ///< the launcher's own address in that network
  int prefix_length = 24;  ///< of all addresses, where the launcher makes the network
  std::vector<HostSpec> hosts;
};

/// Reads and checks a hosts file; throws ScenarioError ("FILE:LINE: ...") for anything that is wrong.
Hosts load_hosts(const std::string& path);
/// The same from text; `file_name` stands in messages.
Hosts parse_hosts(const std::string& text, const std::string& file_name);
/// This machine alone.
Hosts local_hosts(const std::string& interface);

}  // namespace sidestep
