// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/launch/hosts/run_hosts.hpp"

namespace sidestep {

RunHosts::RunHosts(const Hosts& hosts, const Scenario& scenario, bool has_driver)
    : hosts_(hosts), placement_(hosts_, scenario, has_driver) {
  if (!hosts_.create) return;
  remove_abandoned_namespaces();
  bridge_.emplace(network_.emplace(hosts_).bridge());
}

}  // namespace sidestep
