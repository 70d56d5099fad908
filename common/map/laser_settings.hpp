// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

namespace sidestep {

/// The beams of a planar laser scanner.
struct LaserSettings {
  int beams = 360;                                  ///< 1 to 100,000
  double field_of_view_rad = 2 * std::numbers::pi;  ///< 0.001 to a full turn; centred on the heading
  double min_range_m = 0.05, max_range_m = 10;
};

}  // namespace sidestep
