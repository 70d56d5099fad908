// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The noise of a sensor: independent and Gaussian in red, green and blue of each pixel, and in the frame's
/// format what comes of that. Drawn once, on a tape of which every row of a frame takes a piece from
/// somewhere.
class SensorNoise {
 public:
  /// `sd` is the standard deviation of each of red, green and blue, of 255.
  SensorNoise(PixelFormat format, double sd, int width_px, Rng& rng);

  /// out = clean + noise, cut off at 0 and 255. Both have the rows of an image of the width and format given.
  void add(const std::uint8_t* clean, int rows, Rng& rng, std::uint8_t* out) const;

 private:
  std::vector<std::int8_t> tape_;
  std::size_t row_bytes_;
  std::size_t group_bytes_;  ///< pieces begin at multiples of it
  bool is_quiet_;
};

}  // namespace sidestep
