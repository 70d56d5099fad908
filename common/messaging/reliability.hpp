// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "common/time/time.hpp"

namespace sidestep {

/// Properties of the reliable topics (Qos::kEvent) and of discovery that DDS and the simulated network share;
/// README.md lists their consequences.

/// Number of messages per key that a writer keeps for readers that have not acknowledged them.
inline constexpr std::size_t kEventDepth = 64;
/// Period at which a writer asks a reader with outstanding acknowledgements which messages it lacks.
inline constexpr Duration kHeartbeatPeriod{50'000'000};
/// A process that has been silent for this long is forgotten until it is heard again.
inline constexpr Duration kSilenceLimit{6'000'000'000};

}  // namespace sidestep
