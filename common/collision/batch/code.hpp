// SPDX-License-Identifier: Apache-2.0
// Products may be contracted, which rounds differently from one instruction set to the next: what is decided
// leaves more room than that.
#include "common/collision/batch/vectors.hpp"

namespace sidestep::collision {
namespace {

constexpr std::size_t kTogether = 4;  // blocks between which nothing is decided

/// Squared distances from the way less squared reaches: negative where a disc is touched.
inline Vector gaps(const CircleBlock& circles, std::size_t at, const SweepRow& s) {
  const Vector dx = load(circles.x_m + at) - s.x_m, dy = load(circles.y_m + at) - s.y_m;
  const Vector along = smaller(larger(dx * s.along_x_per_m + dy * s.along_y_per_m, all(0)), all(1));
  const Vector ex = dx - along * s.way_x_m, ey = dy - along * s.way_y_m;
  const Vector reach = load(circles.radius_m + at) + s.radius_m;
  return ex * ex + (ey * ey - reach * reach);
}

inline Vector smallest_gaps(const CircleBlock& circles, const SweepRow& s) {
  Vector smallest = gaps(circles, 0, s);
  for (std::size_t at = kWidth; at < kLanes; at += kWidth) smallest = smaller(smallest, gaps(circles, at, s));
  return smallest;
}

Answer sweep(const CircleBlock* circles, std::size_t blocks, const SweepRow& s) {
  const Vector doubt = all(s.doubt_m2);
  unsigned doubtful = 0;
  std::size_t block = 0;
  while (block < blocks) {
    Vector smallest = smallest_gaps(circles[block], s);
    const std::size_t end = block + kTogether < blocks ? block + kTogether : blocks;
    if (end - block == kTogether) {
      for (std::size_t i = 1; i < kTogether; ++i)
        smallest = smaller(smallest, smallest_gaps(circles[block + i], s));
      block = end;
    } else {
      while (++block < end) smallest = smaller(smallest, smallest_gaps(circles[block], s));
    }
    if (not_above(smallest, -doubt) != 0) return Answer::kTouches;
    doubtful |= not_above(smallest, doubt);
  }
  return doubtful != 0 ? Answer::kInDoubt : Answer::kClear;
}

std::size_t next_overlap(const BoxBlock* boxes, std::size_t block, std::size_t blocks, const BoxRow& box,
                         unsigned* lanes) {
  for (; block < blocks; ++block) {
    const BoxBlock& b = boxes[block];
    unsigned bits = 0;
    for (std::size_t at = 0; at < kLanes; at += kWidth) {
      const Vector below = larger(load(b.min_x_m + at) - box.max_x_m, load(b.min_y_m + at) - box.max_y_m);
      const Vector above = larger(box.min_x_m - load(b.max_x_m + at), box.min_y_m - load(b.max_y_m + at));
      bits |= not_above(larger(below, above), all(0)) << at;
    }
    *lanes = bits;
    if (bits != 0) return block;
  }
  return blocks;
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, sweep, next_overlap};

}  // namespace sidestep::collision
