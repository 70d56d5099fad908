// SPDX-License-Identifier: Apache-2.0
// The kernels; see vectors.hpp. Products may be contracted, which rounds differently from one instruction set
// to the next: what is decided leaves more room than that. Buckets do not depend on it.
#include "common/collision/batch/moving_disc.hpp"

namespace sidestep::collision {
namespace {

constexpr std::size_t kBlocksTogether = 4;  // between which nothing is decided
constexpr float kFar_m2 = 1e38f;

inline Vector smallest_gaps(const CircleBlock& circles, const MovingDisc& disc) {
  Vector smallest = all<Vector>(kFar_m2);
  for (std::size_t at = 0; at < kLanes; at += kWidth) {
    const Vector gap = gaps<Vector>(load<Vector>(circles.x_m + at), load<Vector>(circles.y_m + at),
                                    load<Vector>(circles.radius_m + at), disc);
    smallest = smaller(smallest, gap);
  }
  return smallest;
}

/// A box in single precision that holds all that the disc sweeps.
struct SweptBox {
  float min_x_m, min_y_m, max_x_m, max_y_m;
};

inline SweptBox swept_box(const BodiesView& bodies, const double* from_m, const double* to_m,
                          double radius_m) {
  // Enough for what rounding to single precision takes off a number, however small.
  constexpr double kMore = 1 + 0x1p-22, kLess = 1 - 0x1p-22, kLeast = 0x1p-140;
  const double x = from_m[0] - bodies.origin_x_m, y = from_m[1] - bodies.origin_y_m;
  const double to_x = to_m[0] - bodies.origin_x_m, to_y = to_m[1] - bodies.origin_y_m;
  const double min_x = (x < to_x ? x : to_x) - radius_m - kLeast,
               max_x = (x < to_x ? to_x : x) + radius_m + kLeast;
  const double min_y = (y < to_y ? y : to_y) - radius_m - kLeast,
               max_y = (y < to_y ? to_y : y) + radius_m + kLeast;
  return {static_cast<float>(min_x * (min_x < 0 ? kMore : kLess)),
          static_cast<float>(min_y * (min_y < 0 ? kMore : kLess)),
          static_cast<float>(max_x * (max_x < 0 ? kLess : kMore)),
          static_cast<float>(max_y * (max_y < 0 ? kLess : kMore))};
}

/// The bits of a block's boxes that overlap the box.
inline unsigned overlaps(const BoxBlock& boxes, const SweptBox& box) {
  unsigned bits = 0;
  for (std::size_t at = 0; at < kLanes; at += kWidth) {
    bits |= all_not_above(load<Vector>(boxes.min_x_m + at), all<Vector>(box.max_x_m),
                          load<Vector>(boxes.min_y_m + at), all<Vector>(box.max_y_m),
                          all<Vector>(box.min_x_m), load<Vector>(boxes.max_x_m + at),
                          all<Vector>(box.min_y_m), load<Vector>(boxes.max_y_m + at))
            << at;
  }
  return bits;
}

/// Whether an obstacle whose bit is set is touched; `slots` are by bit.
inline bool touches_marked(const Query& query, unsigned bits, const std::uint32_t* slots) {
  bool touched = false;
  while (bits != 0 && !touched) {
    std::uint32_t four[kTogether];
    for (std::uint32_t& slot : four) {
      slot = bits != 0 ? slots[__builtin_ctz(bits)] : query.bodies.nowhere;
      bits &= bits - 1;
    }
    touched = query.touches(four);
  }
  return touched;
}

Answer linear(const LinearView& view, const BodiesView& bodies, const double* from_m, const double* to_m,
              double radius_m) {
  const MovingDisc disc = moving_disc(bodies, from_m, to_m, radius_m);
  if (!disc.is_sound) [[unlikely]]
    return Answer::kInDoubt;
  const Vector doubt = all<Vector>(disc.doubt_m2);
  unsigned doubtful = 0;
  const CircleBlock* circles = view.circles;
  std::size_t blocks = view.circle_blocks;
  for (; blocks > kBlocksTogether; blocks -= kBlocksTogether, circles += kBlocksTogether) {
    Vector smallest = smallest_gaps(circles[0], disc);
    for (std::size_t i = 1; i < kBlocksTogether; ++i)
      smallest = smaller(smallest, smallest_gaps(circles[i], disc));
    if (not_above(smallest, -doubt) != 0) return Answer::kTouches;
    doubtful |= not_above(smallest, doubt);
  }
  Vector smallest = all<Vector>(kFar_m2);
  for (std::size_t i = 0; i < blocks; ++i) smallest = smaller(smallest, smallest_gaps(circles[i], disc));
  doubtful |= not_above(smallest, doubt);
  // No branch depends on what comes of the last circles.
  const auto touched = static_cast<unsigned>(not_above(smallest, -doubt) != 0);
  const unsigned answer = touched | (static_cast<unsigned>(doubtful != 0) & ~touched) << 1;
  if (view.box_blocks == 0 || answer != 0) return static_cast<Answer>(answer);
  const Query query{bodies, disc, from_m, to_m, radius_m};
  const SweptBox box = swept_box(bodies, from_m, to_m, radius_m);
  for (std::size_t block = 0; block < view.box_blocks; ++block) {
    if (touches_marked(query, overlaps(view.boxes[block], box), view.box_slots + block * kLanes))
      return Answer::kTouches;
  }
  return Answer::kClear;
}

/// The buckets of the numbers that bound what the disc sweeps: minimum x and y, maximum x and y.
inline FourInts buckets(const MasksView& view, const double* from_m, const double* to_m, double radius_m) {
  const FourDoubles from{from_m[0], from_m[1], -from_m[0], -from_m[1]};
  const FourDoubles to{to_m[0], to_m[1], -to_m[0], -to_m[1]};
  FourDoubles zero, per_m;
  __builtin_memcpy(&zero, view.zero_m, sizeof zero);
  __builtin_memcpy(&per_m, view.per_m, sizeof per_m);
  const FourDoubles low = smaller(from, to) - radius_m;
  const FourDoubles scaled = (low - zero) * per_m;
  const FourDoubles last = static_cast<double>(kBuckets - 1) - FourDoubles{};
  return __builtin_convertvector(smaller(larger(scaled, FourDoubles{}), last), FourInts);
}

/// Compares with the obstacles of a word's bits.
inline bool touches_word(const Query& query, std::uint64_t bits, std::uint32_t first_slot) {
  bool touched = false;
  do {
    std::uint32_t four[kTogether];
    for (std::uint32_t& slot : four) {
      slot =
          bits != 0 ? first_slot + static_cast<std::uint32_t>(__builtin_ctzll(bits)) : query.bodies.nowhere;
      bits &= bits - 1;
    }
    touched = touched | query.touches(four);
  } while (bits != 0 && !touched);
  return touched;
}

Answer masks(const MasksView& view, const BodiesView& bodies, const double* from_m, const double* to_m,
             double radius_m) {
  const Query query{bodies, moving_disc(bodies, from_m, to_m, radius_m), from_m, to_m, radius_m};
  if (!query.disc.is_sound) [[unlikely]]
    return Answer::kInDoubt;
  const FourInts bucket = buckets(view, from_m, to_m, radius_m);
  const std::size_t words = view.words;
  const std::uint64_t* row[4];
  for (std::size_t i = 0; i < 4; ++i)
    row[i] = view.rows + (i * kBuckets + static_cast<std::size_t>(bucket[i])) * words;
  if (words == 1) return static_cast<Answer>(touches_word(query, *row[0] & *row[1] & *row[2] & *row[3], 0));
  for (std::size_t word = 0; word < words; ++word) {
    const std::uint64_t bits = row[0][word] & row[1][word] & row[2][word] & row[3][word];
    if (bits != 0 && touches_word(query, bits, static_cast<std::uint32_t>(word) * 64))
      return Answer::kTouches;
  }
  return Answer::kClear;
}

Answer tree(const TreeView& view, const BodiesView& bodies, const double* from_m, const double* to_m,
            double radius_m) {
  const Query query{bodies, moving_disc(bodies, from_m, to_m, radius_m), from_m, to_m, radius_m};
  if (!query.disc.is_sound) [[unlikely]]
    return Answer::kInDoubt;
  const SweptBox box = swept_box(bodies, from_m, to_m, radius_m);
  std::uint32_t open[kDeepest * kLanes];
  std::size_t count = 1;
  open[0] = view.root;
  while (count != 0) {
    const TreeNode& node = view.nodes[open[--count]];
    unsigned bits = overlaps(node.boxes, box);
    if (node.is_leaf) {
      if (touches_marked(query, bits, node.children)) return Answer::kTouches;
    } else {
      for (; bits != 0; bits &= bits - 1) open[count++] = node.children[__builtin_ctz(bits)];
    }
  }
  return Answer::kClear;
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, linear, masks, tree};

}  // namespace sidestep::collision
