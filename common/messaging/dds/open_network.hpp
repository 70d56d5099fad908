// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Checks the network of a process without keys. Logs once that any machine on the network can command the
/// robots. Throws std::invalid_argument if other machines can reach the interface, unless
/// DdsSettings::insecure is set. The loopback interface and the network namespaces of `sidestep run` cannot
/// be reached from outside.
void require_safe_network(const DdsSettings& settings);

}  // namespace sidestep
