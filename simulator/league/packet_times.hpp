// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "common/time/time.hpp"

namespace sidestep {

/// Differences between the league's simulators in how they date their packets.
struct PacketTimeSettings {
  /// Times count simulated time from this value at the simulation's start. nullopt: real time since 1970.
  std::optional<Duration> start{};
  Duration capture_error{0};  ///< capture times are this much too late, but not later than the sending time
};

/// When a frame was captured, and when it was sent.
struct FrameStamps {
  Duration captured{0}, sent{0};
};

/// The times to write into the packet of a frame. `real` counts from 1970, and `simulated` from the
/// simulation's start.
FrameStamps packet_times(const PacketTimeSettings& settings, const FrameStamps& real,
                         const FrameStamps& simulated);

}  // namespace sidestep
