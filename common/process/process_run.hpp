// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/process/process.hpp"

namespace sidestep {

/// Runs a program on DDS until SIGINT or SIGTERM. If the host's clock was set after the start and only then
/// agrees with the clocks of others (HostClockWatch), the program begins anew by it, with a new bus and new
/// nodes, as if its process had been restarted. Throws what the bus and the program throw.
void run_program(const Program& program, const Scenario& scenario, const DdsSettings& dds);

}  // namespace sidestep
