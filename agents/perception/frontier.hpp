// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/geometry/segment.hpp"

namespace sidestep {

/// A piece of the border between what was seen free and the rest.
struct Frontier {
  Segment segment;
  /// A person beyond the segment can project over it by this much: at capture if the segment is open, at any
  /// time if it is closed. Of a closed one, 0: nobody who does can touch a robot.
  double bulge_m = 0;
};

}  // namespace sidestep
