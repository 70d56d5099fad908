// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "idl/disturbance.hpp"

namespace sidestep {

/// Descriptions of the kinds of disturbances, indexed by msg::DisturbanceKind.
inline constexpr const char* kDisturbanceTexts[] = {
    "push",  "slip",       "block",     "lift",  "place",       "reboot",  "forget pose",
    "clock", "switch off", "switch on", "carry", "seen beside", "seen as", "seen frozen"};

/// Precondition: the kind is a valid enumerator.
constexpr const char* to_text(msg::DisturbanceKind kind) {
  return kDisturbanceTexts[static_cast<std::size_t>(kind)];
}

}  // namespace sidestep
