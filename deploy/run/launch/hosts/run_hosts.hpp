// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/config/scenario.hpp"
#include "deploy/run/launch/hosts/hosts_file.hpp"
#include "deploy/run/launch/hosts/namespaces.hpp"
#include "deploy/run/launch/hosts/placement.hpp"

namespace sidestep {

/// The hosts of one run, the placement of processes on them, and the network between them if this process
/// creates it. In that case this thread is in the network's bridge namespace for the lifetime of the object.
class RunHosts {
 public:
  /// Passes on exceptions of Placement and NamespaceNetwork.
  RunHosts(const Hosts& hosts, const Scenario& scenario, bool has_driver = false);
  RunHosts(const RunHosts&) = delete;
  RunHosts& operator=(const RunHosts&) = delete;

  const Hosts& hosts() const { return hosts_; }
  const Placement& placement() const { return placement_; }
  /// Null unless this process created the network.
  const NamespaceNetwork* network() const { return network_ ? &*network_ : nullptr; }
  /// The name of a namespace host in `ip netns`.
  std::string namespace_name(const HostSpec& host) const {
    return network_ ? network_->full_name(host.target) : host.target;
  }

 private:
  const Hosts hosts_;
  Placement placement_;
  std::optional<NamespaceNetwork> network_;
  std::optional<ScopedNamespace> bridge_;
};

}  // namespace sidestep
