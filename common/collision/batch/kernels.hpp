// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compiled once for each instruction set: nothing here may be an inline function that linkers merge.
#include <cstddef>
#include <cstdint>

namespace sidestep::collision {

inline constexpr std::size_t kLanes = 16;  ///< of a block, whatever the machine's vectors hold

/// Discs, in metres from an origin that all share.
struct alignas(64) CircleBlock {
  float x_m[kLanes], y_m[kLanes], radius_m[kLanes];
};

/// Boxes, rounded outwards.
struct alignas(64) BoxBlock {
  float min_x_m[kLanes], min_y_m[kLanes], max_x_m[kLanes], max_y_m[kLanes];
};

/// A swept disc. `along` is `way` over its squared length, or 0 for a disc that stands still.
struct SweepRow {
  float x_m, y_m, way_x_m, way_y_m, along_x_per_m, along_y_per_m, radius_m;
  /// How wrong a difference of squared distances may be that comes out near 0.
  float doubt_m2;
};

struct BoxRow {
  float min_x_m, min_y_m, max_x_m, max_y_m;
};

enum class Answer : std::uint8_t { kClear, kTouches, kInDoubt };

/// The inner loops of collision detection for one instruction set.
struct Kernels {
  const char* name;
  /// Whether the swept disc touches one of the discs.
  Answer (*sweep)(const CircleBlock* circles, std::size_t blocks, const SweepRow& sweep);
  /// The first block from `block` on with boxes that overlap the box, and the bits of those; or `blocks`.
  std::size_t (*next_overlap)(const BoxBlock* boxes, std::size_t block, std::size_t blocks, const BoxRow& box,
                              unsigned* lanes);
};

}  // namespace sidestep::collision
