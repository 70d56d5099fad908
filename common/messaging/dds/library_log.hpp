// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// From now on this process's log has what Fast DDS logs, instead of stderr. Of each function of Fast DDS it
/// has only a few lines a minute, because every hostile datagram can cause one. Later calls have no effect.
void log_library();

/// The first few errors that Fast DDS has logged since the last call, or since log_library(); empty if none.
std::string take_library_errors();

}  // namespace sidestep
