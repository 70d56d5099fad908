// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// Packet loss between a namespace host and the other hosts.
struct LinkFault {
  double loss_in = 0;                      ///< probability that an incoming packet is dropped
  double loss_out = 0;                     ///< probability that an outgoing packet is dropped
  std::vector<std::string> cut_from = {};  ///< IPv4 addresses whose packets are all dropped
};

/// The namespaces of a host. `host` is the namespace's name in the hosts file of a running system, its full
/// name, or "all" for every host of the only run. Throws std::runtime_error when the host is unknown, when
/// several runs have a host of that name, and without root.
[[nodiscard]] std::vector<std::string> namespaces_of_host(const std::string& host);

/// Replaces the namespace's filter. Throws std::runtime_error.
void set_link_fault(const std::string& namespace_name, const LinkFault& fault);
/// Removes the filter. Throws std::runtime_error.
void clear_link_fault(const std::string& namespace_name);

}  // namespace sidestep
