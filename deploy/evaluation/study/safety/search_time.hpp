// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Draws so many robots on a floor of 0.7 m² each, all moving and clear of each other, and lets each search
/// once as in a control cycle. Returns the processor's time for it all per robot, in microseconds.
double search_us_per_robot(int robots, std::uint64_t seed);

}  // namespace sidestep
