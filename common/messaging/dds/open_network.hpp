// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/messaging/dds/bus.hpp"

namespace sidestep {

/// Checks the network of a process without keys. If other machines can reach the interface, throws
/// std::invalid_argument, or with DdsSettings::insecure logs once that any machine on the network can command
/// the robots. The loopback interface and the network namespaces of `sidestep run` cannot be reached from
/// outside.
void require_safe_network(const DdsSettings& settings);

}  // namespace sidestep
