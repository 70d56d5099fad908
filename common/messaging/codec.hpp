// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/motion/version.hpp"
#include "idl/trajectory.h"

namespace sidestep {

/// A version as it came over the network, checked: finite and within what any robot can do, times and
/// durations within bounds, phase count in range, robot id in range. nullopt when it is not.
std::optional<Version> decode(const msg::Version& message);

msg::Version encode(const Version& version);

}  // namespace sidestep
