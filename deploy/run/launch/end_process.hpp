// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "deploy/run/launch/processes.hpp"

namespace sidestep {

/// Asks a child to end, kills it if it has not ended after the timeout, and waits for its end. Discards the
/// events of other children meanwhile. No effect if the child is not running.
void end_process(Processes& processes, const std::string& name, Processes::Milliseconds timeout);

}  // namespace sidestep
