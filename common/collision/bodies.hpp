// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/shapes.hpp"
#include "common/collision/sweep.hpp"

namespace sidestep {

/// Where an obstacle is kept: a small number, given again once it is free.
using Slot = std::uint32_t;

/// Shapes by slot, and the exact comparison with each. Circles, which are most, are kept so that one is
/// compared from half a cache line.
class Bodies {
 public:
  /// Takes the shape in, which has to be a right one (see check), and says where.
  Slot add(Shape shape);
  void replace(Slot slot, Shape shape);
  void remove(Slot slot);

  bool has(Slot slot) const { return slot < kept_.size() && kept_[slot].kind != Kind::kNone; }
  const Shape& shape(Slot slot) const { return shapes_[slot]; }
  const Circle* circle(Slot slot) const { return std::get_if<Circle>(&shapes_[slot]); }
  /// Slots in use, in no order.
  const std::vector<Slot>& slots() const { return slots_; }

  /// Exact but for the last digits.
  bool touches(Slot slot, const Sweep& sweep) const {
    const Kept& kept = kept_[slot];
    if (kept.kind == Kind::kCircle) return sweep.touches(kept.x_m, kept.y_m, kept.radius_m);
    return touches_shape(slot, sweep);
  }

 private:
  enum class Kind : std::uint32_t { kNone, kCircle, kOther };
  struct alignas(32) Kept {
    double x_m = 0, y_m = 0, radius_m = 0;
    Kind kind = Kind::kNone;
    std::uint32_t place = 0;  // in slots_
  };

  bool touches_shape(Slot slot, const Sweep& sweep) const;

  std::vector<Kept> kept_;
  std::vector<Shape> shapes_;
  std::vector<Slot> slots_, free_;
};

}  // namespace sidestep
