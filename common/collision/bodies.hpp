// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "common/collision/batch/kernels.hpp"
#include "common/collision/shapes.hpp"
#include "common/collision/sweep.hpp"

namespace sidestep {

/// Where an obstacle is kept: a small number, given again once it is free.
using Slot = std::uint32_t;

/// The obstacle nearest to a point: infinitely far where there is none.
struct NearestSlot {
  double distance_m = std::numeric_limits<double>::infinity();
  Slot slot = 0xffffffffu;
};

/// Shapes by slot, and the exact comparison with each.
class Bodies {
 public:
  /// Takes shapes in the slots 0, 1, 2, …; they have to be right ones (see check). Their middle is the origin
  /// that positions in single precision are from.
  explicit Bodies(std::vector<Shape> shapes);

  Slot add(Shape shape);
  void replace(Slot slot, Shape shape);
  void remove(Slot slot);

  bool has(Slot slot) const { return slot < places_.size() && places_[slot] != kNowhere; }
  const Shape& shape(Slot slot) const { return shapes_[slot]; }
  /// Slots in use, in no order.
  const std::vector<Slot>& slots() const { return slots_; }
  /// All slots, in use or not, are below.
  Slot end() const { return static_cast<Slot>(shapes_.size()); }
  const Vec2& origin_m() const { return origin_m_; }
  /// All obstacles are within, and ever were.
  Box bounds_m() const { return grown({origin_m_, origin_m_}, farthest_m_); }

  /// Exact but for the last digits.
  bool touches(Slot slot, const Sweep& sweep) const;
  /// Takes the obstacle for the nearest one if it is nearer.
  void compare(Slot slot, const Vec2& at_m, NearestSlot& nearest) const;
  /// Compares all.
  NearestSlot nearest(const Vec2& at_m) const;
  /// For kernels, until anything changes.
  collision::BodiesView view() const;

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffu;

  void record(Slot slot);
  void record_edges(Slot slot, std::span<const Vec2> corners);
  /// Takes edges anew, without those of shapes that are gone.
  void compact();

  std::vector<Shape> shapes_;
  std::vector<std::uint32_t> places_;  // in slots_, by slot
  std::vector<Slot> slots_, free_;
  Vec2 origin_m_{0, 0};
  double farthest_m_ = 0, largest_radius_m_ = 0;  // of anything, from the origin along an axis; of a circle
  std::vector<collision::BodyRecord> records_;    // by slot, and some more
  std::vector<collision::EdgeBlock> edges_;
  std::size_t unused_edges_ = 0;  // blocks
};

/// A number in single precision that is surely not above, or not below.
float rounded_down(double value);
float rounded_up(double value);

}  // namespace sidestep
