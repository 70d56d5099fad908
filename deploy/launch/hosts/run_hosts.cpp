// SPDX-License-Identifier: Apache-2.0
#include "deploy/launch/hosts/run_hosts.hpp"

namespace sidestep {

RunHosts::RunHosts(const Hosts& hosts, const Scenario& scenario)
    : hosts_(hosts), placement_(hosts_, scenario) {
  if (!hosts_.create) return;
  remove_abandoned_namespaces();
  bridge_.emplace(network_.emplace(hosts_).bridge());
}

}  // namespace sidestep
