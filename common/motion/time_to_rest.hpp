// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "common/motion/limits.hpp"
#include "common/time/time.hpp"

namespace sidestep {

/// Time in which robots that get no more versions come to rest: a second for the longest acceleration of a
/// version and the latency of bases, and then the braking.
inline Duration time_to_rest(const MotionLimits& limits) {
  return std::chrono::seconds(1) + from_seconds(limits.speed_mps / limits.deceleration_mps2);
}

}  // namespace sidestep
