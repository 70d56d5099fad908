// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Listens for half a second. Throws std::invalid_argument if a coordinator is running in the domain. The
/// message names the coordinator and the start of its run, and its host and scenario if it reports them
/// within two more seconds. Passes on exceptions of DdsBus's constructor.
void require_free_domain(const DdsSettings& dds);

}  // namespace sidestep
