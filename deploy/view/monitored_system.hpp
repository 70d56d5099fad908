// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/view/monitor_options.hpp"

namespace sidestep {

/// Shows a running system until SIGINT or SIGTERM. If `sidestep run` has started the monitor, it shows the
/// run as a recording once the run is over, without using the network any more, until its input ends. Returns
/// the exit code. Throws std::runtime_error if the port or a file cannot be used.
int monitor_system(const MonitorOptions& options);

}  // namespace sidestep
