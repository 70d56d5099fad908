// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace sidestep {

/// What the network of a host that this machine plays does to its packets from and to other hosts.
struct LinkFault {
  double loss_in = 0;   ///< probability that a packet that arrives is dropped
  double loss_out = 0;  ///< that one that leaves is
};

/// The namespaces that stand for a host: by its name in the hosts file of a run that goes on, by the
/// namespace's own name, or "all" hosts of the one run. Throws std::runtime_error saying why it cannot be
/// found: no such host, several runs that have it, no right.
std::vector<std::string> namespaces_of_host(const std::string& host);

/// Sets the filter, instead of any before. Throws std::runtime_error.
void set_link_fault(const std::string& namespace_name, const LinkFault& fault);
/// Lets everything through again. Throws std::runtime_error.
void clear_link_fault(const std::string& namespace_name);

}  // namespace sidestep
