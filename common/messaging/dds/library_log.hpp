// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace sidestep {

/// Redirects Fast DDS's log from stderr to this process's log. Only a few lines per minute are kept for each
/// function of Fast DDS, because every hostile datagram can cause one. Later calls have no effect.
void log_library();

/// The first few errors that Fast DDS has logged since the last call or, at the first call, since
/// log_library(); empty if none.
std::string take_library_errors();

}  // namespace sidestep
