// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Samples robots with 0.7 m² of floor each, all moving and clear of each other, and runs each robot's safety
/// search once, as in a control cycle. Returns the processor time per robot in microseconds.
double search_us_per_robot(int robots, std::uint64_t seed);

}  // namespace sidestep
