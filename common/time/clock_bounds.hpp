// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// The largest difference of two clocks that are both within the clock bound of the coordinator's.
constexpr Duration max_clock_difference(double clock_bound_s) { return from_seconds(2 * clock_bound_s); }

/// Vision's own clock dates no observation, so it may be off by more than the clock bound: it may be ahead of
/// the cameras' by this much.
inline constexpr Duration kMaxVisionLead{100'000'000};

/// How far the time of a frame, of a world or of a list of obstacles may be ahead of the receiver's clock.
constexpr Duration max_vision_lead(Duration max_clock_difference) {
  return kMaxVisionLead + max_clock_difference;
}

}  // namespace sidestep
