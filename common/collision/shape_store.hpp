// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "common/collision/batch/kernels.hpp"
#include "common/collision/shapes.hpp"
#include "common/collision/sweep.hpp"

namespace sidestep {

/// Index under which an obstacle is stored; reused after removal.
using Slot = std::uint32_t;

/// The obstacle nearest to a point; infinitely far if there is none.
struct NearestSlot {
  double distance_m = std::numeric_limits<double>::infinity();
  Slot slot = 0xffffffffu;
};

/// Shapes of a world, indexed by slot: in double precision for exact comparisons, and as records for the
/// batch kernels.
class ShapeStore {
 public:
  /// Stores the shapes in slots 0, 1, 2, …. Precondition: all are valid (see check()). The centre of their
  /// bounding box becomes the origin of positions in single precision.
  explicit ShapeStore(std::vector<Shape> shapes);

  Slot add(Shape shape);
  void replace(Slot slot, Shape shape);
  void remove(Slot slot);

  bool has(Slot slot) const { return slot < indices_.size() && indices_[slot] != kUnused; }
  const Shape& shape(Slot slot) const { return shapes_[slot]; }
  /// Slots in use, in no particular order.
  const std::vector<Slot>& slots() const { return slots_; }
  /// Upper bound (exclusive) of all slots, including unused ones.
  Slot end() const { return static_cast<Slot>(shapes_.size()); }
  const Vec2& origin_m() const { return origin_m_; }
  /// A box that contains all obstacles, including removed ones.
  Box bounds_m() const { return inflated({origin_m_, origin_m_}, max_coordinate_m_); }

  /// Exact contact test in double precision.
  bool touches(Slot slot, const Sweep& sweep) const;
  /// Replaces `nearest` with this obstacle if the obstacle is nearer.
  void compare(Slot slot, const Vec2& at_m, NearestSlot& nearest) const;
  /// The nearest obstacle, found by brute force.
  NearestSlot nearest(const Vec2& at_m) const;
  /// A view for kernels; invalidated by any change.
  collision::ShapesView view() const;

 private:
  static constexpr std::uint32_t kUnused = 0xffffffffu;

  void write_record(Slot slot);
  void write_edges(Slot slot, std::span<const Vec2> corners);
  /// Rewrites the edges of all shapes, dropping those of removed shapes.
  void rebuild_edges();

  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> indices_;  // indexed by slot: position in slots_
  std::vector<Slot> slots_, free_;
  Vec2 origin_m_{0, 0};
  double max_coordinate_m_ = 0;  // largest coordinate of any shape so far, relative to the origin
  double max_radius_m_ = 0;      // largest radius of any circle so far
  std::vector<collision::ShapeRecord> records_;  // indexed by slot, with padding
  std::vector<collision::EdgeBlock> edges_;
  std::size_t unused_edges_ = 0;  // number of unused edge blocks
};

/// Convert to single precision, rounding down or up.
float rounded_down(double value);
float rounded_up(double value);

}  // namespace sidestep
