// SPDX-License-Identifier: Apache-2.0
#pragma once

// Included by sources compiled for different instruction sets: this header must not contain inline functions,
// because the linker would merge their copies.
#include <cstddef>
#include <cstdint>

namespace sidestep::collision {

inline constexpr std::size_t kLanes = 16;     ///< lanes per block, independent of the machine's vector width
inline constexpr std::size_t kBuckets = 256;  ///< buckets per axis in extent masks

/// An obstacle, relative to the origin: a circle or, if `radius_m` is NaN, a shape with edges, the first of
/// which are in the block `edges`.
struct alignas(16) ShapeRecord {
  float x_m, y_m, radius_m;
  std::uint32_t edges;
};

/// Four edges of a convex shape, one per lane: start point, edge vector, and edge vector divided by its
/// squared length. The shape lies to the left of all edges. A segment has two edges, one in each direction.
/// Unused lanes repeat the last edge.
struct alignas(32) EdgeBlock {
  float x_m[4], y_m[4], edge_x_m[4], edge_y_m[4], along_x_per_m[4], along_y_per_m[4];
  std::uint32_t following;  ///< number of further blocks that belong to the same shape
};

/// All obstacles, indexed by slot, and single-precision error bounds for them.
struct ShapesView {
  double origin_m[2];
  float limit_m;  ///< queries with a larger coordinate or radius remain undecided
  float error_m;  ///< upper bound of the error of a distance up to limit_m
  /// Bound of the error of a gap (a difference of squared distances) near 0: `gap_error_per_m` times the
  /// query's radius, plus `min_gap_error_m2`.
  float gap_error_per_m, min_gap_error_m2;
  const ShapeRecord* records;  ///< indexed by slot; kernels may read a few entries beyond the last slot
  const EdgeBlock* edges;
  /// The exact comparison in double precision.
  bool (*touches)(const void* store, std::uint32_t slot, const double* from_m, const double* to_m,
                  double radius_m);
  const void* store;
};

/// Circles, relative to the origin.
struct alignas(64) CircleBlock {
  float x_m[kLanes], y_m[kLanes], radius_m[kLanes];
};

/// Boxes, relative to the origin and rounded outwards; NaN in empty lanes.
struct alignas(64) BoxBlock {
  float min_x_m[kLanes], min_y_m[kLanes], max_x_m[kLanes], max_y_m[kLanes];
};

/// Circles, and the bounding boxes of other shapes.
struct LinearView {
  const CircleBlock* circles;
  std::size_t circle_blocks;
  const BoxBlock* boxes;
  std::size_t box_blocks;
  const std::uint32_t* box_slots;  ///< indexed by lane
};

/// Extent masks: four consecutive tables of kBuckets rows. A row has `words` words with one bit per slot. The
/// first two tables (x, y) mark the obstacles that end in or after a bucket, the last two (x, y) those that
/// begin in or before a bucket. The bucket of a coordinate v is v * per_m + shift, truncated and
/// clamped. The last two tables are looked up with -v, so their `per_m` is negative.
struct MasksView {
  const std::uint64_t* rows;
  std::size_t words;
  const float *per_m, *shift;  ///< one entry per table
};

/// A node of a box tree: boxes, and the node or slot that each box belongs to. Kernels may also read the
/// entries of empty lanes.
struct TreeNode {
  BoxBlock boxes;
  std::uint32_t children[kLanes];
  std::uint32_t parent, lane;  ///< the parent node, and this node's lane in the parent
  std::uint32_t count;         ///< number of lanes in use, from lane 0 on
  bool is_leaf;
};

inline constexpr std::size_t kMaxDepth = 16;  ///< maximum number of nodes on a path from the root to a leaf

struct TreeView {
  const TreeNode* nodes;
  std::uint32_t root;
};

enum class SweepResult : unsigned { kClear = 0, kTouches = 1, kUndecided = 2 };

/// The obstacles of a world, and the view of the structure in use; the other views are unset.
struct WorldView {
  ShapesView shapes;
  LinearView linear;
  MasksView masks;
  TreeView tree;
};

/// Whether a disc that moves along a segment touches an obstacle. The result is undecided for motions that
/// are not finite or too far away, for negative radii and, with the linear kernel, for contacts with a circle
/// within rounding error: these need the exact comparison with all obstacles.
using SweepKernel = SweepResult (*)(const WorldView& world, const double* from_m, const double* to_m,
                                    double radius_m);

/// The inner loops of collision detection for one instruction set.
struct Kernels {
  const char* name;
  SweepKernel linear, one_word_masks, masks, tree;
};

}  // namespace sidestep::collision
