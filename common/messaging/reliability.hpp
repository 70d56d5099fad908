// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/time/time.hpp"

namespace sidestep {

/// Properties of the reliable topics (Qos::kEvent) and of discovery that DDS and the simulated network share;
/// README.md lists what follows from them.

/// So many of its last messages of each key a writer keeps for a reader that has not acknowledged them.
inline constexpr std::size_t kEventDepth = 64;
/// While a reader has not acknowledged everything, its writer asks it this often what it lacks.
inline constexpr Duration kHeartbeatPeriod{50'000'000};
/// A process that has been silent for this long is forgotten, until it is heard again.
inline constexpr Duration kSilenceLimit{6'000'000'000};

}  // namespace sidestep
