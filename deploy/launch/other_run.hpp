// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Listens for half a second. Throws std::invalid_argument if a coordinator works in the domain: the message
/// names it and the start of its run, and its host and scenario if it tells them within two seconds more.
/// Throws also as the constructor of DdsBus does.
void require_free_domain(const DdsSettings& dds);

}  // namespace sidestep
