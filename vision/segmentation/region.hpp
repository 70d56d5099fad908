// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// A connected component of one colour in 8-connectivity. Pixel (0, 0) is the upper left one; pixel centres
/// have integer coordinates.
struct Region {
  std::uint32_t colour = 0;
  std::uint32_t area_px = 0;  ///< number of pixels
  double x_px = 0;            ///< centroid
  double y_px = 0;
  int left_px = 0;  ///< bounding box, inclusive
  int right_px = 0;
  int top_px = 0;
  int bottom_px = 0;

  bool operator==(const Region&) const = default;
};

}  // namespace sidestep
