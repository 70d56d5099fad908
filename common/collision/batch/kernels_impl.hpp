// SPDX-License-Identifier: Apache-2.0
// The kernels; see vectors.hpp for the rules of inclusion. The compiler may fuse multiplications and
// additions, whose rounding then differs between instruction sets. The error bounds cover this.
#include "common/collision/batch/moving_disc.hpp"

namespace sidestep::collision {
namespace {

constexpr std::size_t kBlocksPerBatch = 4;  // number of circle blocks compared before the kernel may return
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

/// A bounding box of the area that the disc sweeps.
struct SweptBox {
  float min_x_m, min_y_m, max_x_m, max_y_m;
};

inline SweptBox swept_box(const ShapesView& shapes, const MovingDisc& disc) {
  const FourFloats from = disc.ends_m, to = __builtin_shufflevector(from, from, 2, 3, 0, 1);
  const float reach = disc.radius_m + shapes.error_m;
  const FourFloats low = smaller(from, to) - reach, high = larger(from, to) + reach;
  return {low[0], low[1], high[0], high[1]};
}

/// Bits of the lanes whose boxes overlap the swept box.
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

SweepResult linear(const WorldView& world, const double* from_m, const double* to_m, double radius_m) {
  const ShapesView& shapes = world.shapes;
  const LinearView& view = world.linear;
  const MovingDisc disc = moving_disc(shapes, from_m, to_m, radius_m);
  if (!disc.is_valid) [[unlikely]]
    return SweepResult::kUndecided;
  const Vector gap_error = all<Vector>(disc.gap_error_m2);
  unsigned undecided = 0;
  const CircleBlock* circles = view.circles;
  std::size_t blocks = view.circle_blocks;
  for (; blocks > kBlocksPerBatch; blocks -= kBlocksPerBatch, circles += kBlocksPerBatch) {
    Vector smallest = smallest_gaps(circles[0], disc);
    for (std::size_t i = 1; i < kBlocksPerBatch; ++i)
      smallest = smaller(smallest, smallest_gaps(circles[i], disc));
    if (not_above(smallest, -gap_error) != 0) return SweepResult::kTouches;
    undecided |= not_above(smallest, gap_error);
  }
  Vector smallest = all<Vector>(kFar_m2);
  for (std::size_t i = 0; i < blocks; ++i) smallest = smaller(smallest, smallest_gaps(circles[i], disc));
  undecided |= not_above(smallest, gap_error);
  // The result for the last circles is computed without branches.
  const auto touched = static_cast<unsigned>(not_above(smallest, -gap_error) != 0);
  const unsigned result = touched | (static_cast<unsigned>(undecided != 0) & ~touched) << 1;
  if (view.box_blocks == 0 || result != 0) return static_cast<SweepResult>(result);
  const SweptBox box = swept_box(shapes, disc);
  for (std::size_t block = 0; block < view.box_blocks; ++block) {
    const std::uint32_t* slots = view.box_slots + block * kLanes;
    for (unsigned bits = overlaps(view.boxes[block], box); bits != 0; bits &= bits - 1) {
      if (touches_undecided(shapes, disc, from_m, to_m, radius_m, slots[lowest(bits)]))
        return SweepResult::kTouches;
    }
  }
  return SweepResult::kClear;
}

/// The buckets of the swept area's bounds: minimum x and y, maximum x and y.
inline FourInts buckets(const MasksView& view, const ShapesView& shapes, const MovingDisc& disc) {
  const FourFloats ends = disc.ends_m, turned = -ends;
  const FourFloats low = smaller(__builtin_shufflevector(ends, turned, 0, 1, 4, 5),
                                 __builtin_shufflevector(ends, turned, 2, 3, 6, 7)) -
                         (disc.radius_m + shapes.error_m);
  const FourFloats scaled = low * load<FourFloats>(view.per_m) + load<FourFloats>(view.shift);
  const FourInts bucket = __builtin_convertvector(smaller(scaled, all<FourFloats>(kBuckets - 1)), FourInts);
  return bucket > 0 ? bucket : FourInts{};
}

/// The rows that a query's four buckets select, one in each table.
struct Rows {
  const std::uint64_t* row[4];

  std::uint64_t candidates(std::size_t word) const {
    return row[0][word] & row[1][word] & row[2][word] & row[3][word];
  }
};

inline Rows rows(const MasksView& view, const FourInts& bucket, std::size_t words) {
  Rows found{};
  for (std::size_t i = 0; i < 4; ++i)
    found.row[i] = view.rows + (i * kBuckets + static_cast<std::uint32_t>(bucket[i])) * words;
  return found;
}

SweepResult one_word_masks(const WorldView& world, const double* from_m, const double* to_m,
                           double radius_m) {
  const Query query{world.shapes, moving_disc(world.shapes, from_m, to_m, radius_m), from_m, to_m, radius_m};
  if (!query.disc.is_valid) [[unlikely]]
    return SweepResult::kUndecided;
  const std::uint64_t bits =
      rows(world.masks, buckets(world.masks, world.shapes, query.disc), 1).candidates(0);
  if (bits == 0) return SweepResult::kClear;
  return static_cast<SweepResult>(touches_marked(query, bits, [](unsigned bit) { return bit; }));
}

SweepResult masks(const WorldView& world, const double* from_m, const double* to_m, double radius_m) {
  const MasksView& view = world.masks;
  const Query query{world.shapes, moving_disc(world.shapes, from_m, to_m, radius_m), from_m, to_m, radius_m};
  if (!query.disc.is_valid) [[unlikely]]
    return SweepResult::kUndecided;
  const Rows found = rows(view, buckets(view, world.shapes, query.disc), view.words);
  for (std::size_t word = 0; word < view.words; ++word) {
    const std::uint64_t bits = found.candidates(word);
    const auto slot = [word](unsigned bit) { return static_cast<std::uint32_t>(word) * 64 + bit; };
    if (bits != 0 && touches_marked(query, bits, slot)) return SweepResult::kTouches;
  }
  return SweepResult::kClear;
}

SweepResult tree(const WorldView& world, const double* from_m, const double* to_m, double radius_m) {
  const ShapesView& shapes = world.shapes;
  const Query query{shapes, moving_disc(shapes, from_m, to_m, radius_m), from_m, to_m, radius_m};
  if (!query.disc.is_valid) [[unlikely]]
    return SweepResult::kUndecided;
  const SweptBox box = swept_box(shapes, query.disc);
  std::uint32_t open[kMaxDepth * kLanes];
  std::size_t count = 1;
  open[0] = world.tree.root;
  while (count != 0) {
    const TreeNode& node = world.tree.nodes[open[--count]];
    unsigned bits = overlaps(node.boxes, box);
    if (node.is_leaf) {
      const auto slot = [&node](unsigned bit) { return node.children[bit % kLanes]; };
      if (bits != 0 && touches_marked(query, bits, slot)) return SweepResult::kTouches;
    } else {
      for (; bits != 0; bits &= bits - 1) open[count++] = node.children[lowest(bits)];
    }
  }
  return SweepResult::kClear;
}

}  // namespace

const Kernels SIDESTEP_KERNELS{SIDESTEP_LEVEL, linear, one_word_masks, masks, tree};

}  // namespace sidestep::collision
