// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace sidestep {

/// Pixels of one colour that hang together, corners included. Pixel (0, 0) is the upper left one, and a
/// pixel's centre has whole numbers.
struct Region {
  std::uint32_t colour = 0;   ///< of the boxes that its pixels lie in
  std::uint32_t area_px = 0;  ///< number of pixels
  double x_px = 0;            ///< their mean
  double y_px = 0;
  int left_px = 0;  ///< columns and rows of the outermost ones
  int right_px = 0;
  int top_px = 0;
  int bottom_px = 0;

  bool operator==(const Region&) const = default;
};

}  // namespace sidestep
