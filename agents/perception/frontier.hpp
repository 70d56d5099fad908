// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/segment.hpp"

namespace sidestep {

/// A piece of the border between the floor that was seen free and the rest of the floor.
struct Frontier {
  Segment segment;
  /// How far a person whose centre is beyond the segment can protrude across it: at capture if the segment is
  /// open, at any time if it is closed. 0 for a closed segment if a person who protrudes across it cannot
  /// touch a robot.
  double bulge_m = 0;
};

}  // namespace sidestep
