// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace sidestep {

/// Where an edge crosses a pixel, its share of the pixel is counted over so many points.
inline constexpr std::size_t kSamples = 128;

/// One coordinate of each sample, in -1/2 to 1/2, their mean 0.
using SampleAxis = std::array<float, kSamples>;

/// Points on the floor or at some height, in metres, in a frame that the code says.
struct Points {
  SampleAxis x, y;
};

/// The points in a pixel and in the exposure: a rank-1 lattice, so that every line, row, column and instant
/// has its fair share, however an edge lies (Sloan, Joe 1994).
struct SamplePattern {
  SampleAxis x, y, time;
};

constexpr SamplePattern make_samples() {
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

inline constexpr SamplePattern kSamplePattern = make_samples();

}  // namespace sidestep
