// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

/// Writes the events of all processes of a system to this process's log. Each line has the virtual time since
/// the start of the system and the simulated process's name. Sets the level of the log.
void log_events_of(SimSystem& system, LogLevel level);

}  // namespace sidestep
