// SPDX-License-Identifier: Apache-2.0
#pragma once

// Compiled once for each instruction set: nothing here may be an inline function that linkers merge.
#include <cstddef>
#include <cstdint>

namespace sidestep::collision {

inline constexpr std::size_t kLanes = 16;     ///< of a block, whatever the machine's vectors hold
inline constexpr std::size_t kBuckets = 256;  ///< into which an axis is divided for masks

/// An obstacle by slot, in metres from the origin: a circle, or, where there is no number for a radius, what
/// has edges from a block on.
struct alignas(16) BodyRecord {
  float x_m, y_m, radius_m;
  std::uint32_t edges;
};

/// Four edges of a convex shape, which lies to the left of all, one to a lane: where they begin, the way
/// along them, and that over its squared length. A segment has two, there and back; the last one may fill
/// more lanes.
struct alignas(32) EdgeBlock {
  float x_m[4], y_m[4], via_x_m[4], via_y_m[4], along_x_per_m[4], along_y_per_m[4];
  std::uint32_t more;  ///< blocks of the same shape that follow
};

/// Obstacles one by one, and what single precision has to know of all of them.
struct BodiesView {
  double origin_m[2];
  float limit_m;  ///< places and radii in queries are not decided in single precision beyond
  float error_m;  ///< more than a distance up to there may be wrong by
  /// How wrong differences of squared distances may be that come out near 0: a factor for a query's radius,
  /// and what is added to that.
  float doubt_per_m, least_doubt_m2;
  const BodyRecord* records;  ///< by slot; some more may be read
  const EdgeBlock* edges;
  /// Compares exactly.
  bool (*touches)(const void* bodies, std::uint32_t slot, const double* from_m, const double* to_m,
                  double radius_m);
  const void* bodies;
};

/// Discs, in metres from the origin.
struct alignas(64) CircleBlock {
  float x_m[kLanes], y_m[kLanes], radius_m[kLanes];
};

/// Boxes, in metres from the origin, rounded outwards; not a number where there is none.
struct alignas(64) BoxBlock {
  float min_x_m[kLanes], min_y_m[kLanes], max_x_m[kLanes], max_y_m[kLanes];
};

/// Circles, and the boxes of other shapes.
struct LinearView {
  const CircleBlock* circles;
  std::size_t circle_blocks;
  const BoxBlock* boxes;
  std::size_t box_blocks;
  const std::uint32_t* box_slots;  ///< by lane
};

/// Four tables of kBuckets rows of `words` words with a bit for each slot, one after the other: who does not
/// end before a bucket (in x, in y), and who begins before its end (in x, in y). The bucket of a number v is
/// (v - zero) * per_m, cut off and to the range. The latter two tables are looked up by the number's
/// negative, so the signs of their zero and scale are turned.
struct MasksView {
  const std::uint64_t* rows;
  std::size_t words;
  const float *per_m, *shift;  ///< four of each
};

/// A node of a tree: boxes, and which node or slot each is of. Where there is none, that may be looked up
/// still.
struct TreeNode {
  BoxBlock boxes;
  std::uint32_t children[kLanes];
  std::uint32_t parent, lane;  ///< of the parent, and which of its lanes this is
  std::uint32_t count;         ///< lanes in use, the first ones
  bool is_leaf;
};

inline constexpr std::size_t kDeepest = 16;  ///< nodes from the root to a leaf

struct TreeView {
  const TreeNode* nodes;
  std::uint32_t root;
};

enum class Answer : unsigned { kClear = 0, kTouches = 1, kInDoubt = 2 };

/// A world's obstacles, and the one of the sets of them that is in use.
struct WorldView {
  BodiesView bodies;
  LinearView linear;
  MasksView masks;
  TreeView tree;
};

/// Whether a disc on its way touches an obstacle. In doubt are ways that are not finite or far away, negative
/// radii, and, with the linear array, circles touched but for rounding: then all has to be compared exactly.
using SweepKernel = Answer (*)(const WorldView& world, const double* from_m, const double* to_m,
                               double radius_m);

/// The inner loops of collision detection for one instruction set.
struct Kernels {
  const char* name;
  SweepKernel linear, one_word_masks, masks, tree;
};

}  // namespace sidestep::collision
