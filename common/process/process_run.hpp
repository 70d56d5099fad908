// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/process/process.hpp"

namespace sidestep {

/// Runs a program on DDS until SIGINT or SIGTERM. If the host's clock is set after the start and thereby
/// comes to agree with the others' clocks (HostClockWatch), the program restarts with a new bus and new
/// nodes, as if its process had been restarted. Passes on the exceptions of the bus and the program.
void run_program(const Program& program, const Scenario& scenario, const DdsSettings& dds);

}  // namespace sidestep
