// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace sidestep {

/// Number of sample points per pixel, from which the covered fraction of a pixel at an edge is computed.
inline constexpr std::size_t kSamples = 128;

/// One coordinate for every sample.
using SampleAxis = std::array<float, kSamples>;

/// Points in a horizontal plane, in metres.
struct Points {
  SampleAxis x, y;
};

/// The samples' coordinates in a pixel and in the exposure, each from -1/2 to 1/2 with mean 0: a rank-1
/// lattice, which samples rows, columns, edges of any direction and the exposure evenly (Sloan and Joe,
/// Lattice Methods for Multiple Integration, 1994).
struct SamplePattern {
  SampleAxis x, y, time;
};

constexpr SamplePattern make_sample_pattern() {
  SamplePattern pattern{};
  for (std::size_t i = 0; i < kSamples; ++i) {
    const auto at = [](std::size_t step) {
      return (static_cast<float>(step % kSamples) + 0.5F) / static_cast<float>(kSamples) - 0.5F;
    };
    pattern.x[i] = at(i);
    pattern.y[i] = at(111 * i);
    pattern.time[i] = at(105 * i);
  }
  return pattern;
}

inline constexpr SamplePattern kSamplePattern = make_sample_pattern();

}  // namespace sidestep
