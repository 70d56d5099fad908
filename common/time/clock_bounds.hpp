// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/time/time.hpp"

namespace sidestep {

/// Maximum difference between two clocks that are both within the clock bound of the coordinator's clock.
constexpr Duration max_clock_difference(double clock_bound_s) { return from_seconds(2 * clock_bound_s); }

/// Maximum amount by which vision's clock may be ahead of the cameras'. It may exceed the clock bound,
/// because no observation is timestamped by vision's own clock.
inline constexpr Duration kMaxVisionLead{100'000'000};

/// Maximum amount by which the time of a frame, a world state or a list of obstacles may be ahead of the
/// receiver's clock.
constexpr Duration max_vision_lead(Duration max_clock_difference) {
  return kMaxVisionLead + max_clock_difference;
}

}  // namespace sidestep
