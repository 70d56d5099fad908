// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// A camera sensor's noise: independent and Gaussian in red, green and blue of each pixel, converted to the
/// frame's format. It is precomputed in a table; each row of a frame uses a section of the table that starts
/// at a random position.
class SensorNoise {
 public:
  /// `sd` is the standard deviation in each of red, green and blue, in levels of 255.
  SensorNoise(PixelFormat format, double sd, int width_px, Rng& rng);

  /// Computes out = clean + noise, clamped to 0..255. Both images must have the constructor's format and
  /// width.
  void add(const std::uint8_t* clean, int rows, Rng& rng, std::uint8_t* out) const;

 private:
  std::vector<std::int8_t> noise_table_;
  std::size_t row_bytes_;
  std::size_t group_bytes_;  ///< sections start at multiples of this
  bool is_noiseless_;
};

}  // namespace sidestep
