// SPDX-License-Identifier: Apache-2.0
#include "common/collision/bodies.hpp"

namespace sidestep {

Slot Bodies::add(Shape shape) {
  Slot slot = static_cast<Slot>(kept_.size());
  if (free_.empty()) {
    kept_.emplace_back();
    shapes_.emplace_back();
  } else {
    slot = free_.back();
    free_.pop_back();
  }
  kept_[slot].place = static_cast<std::uint32_t>(slots_.size());
  slots_.push_back(slot);
  replace(slot, std::move(shape));
  return slot;
}

void Bodies::replace(Slot slot, Shape shape) {
  Kept& kept = kept_[slot];
  kept.kind = Kind::kOther;
  if (const auto* circle = std::get_if<Circle>(&shape)) {
    kept.kind = Kind::kCircle;
    kept.x_m = circle->centre_m.x();
    kept.y_m = circle->centre_m.y();
    kept.radius_m = circle->radius_m;
  }
  shapes_[slot] = std::move(shape);
}

void Bodies::remove(Slot slot) {
  Kept& kept = kept_[slot];
  kept_[slots_.back()].place = kept.place;
  slots_[kept.place] = slots_.back();
  slots_.pop_back();
  kept.kind = Kind::kNone;
  shapes_[slot] = Circle{};
  free_.push_back(slot);
}

bool Bodies::touches_shape(Slot slot, const Sweep& sweep) const {
  return squared_distance(sweep.segment(), shapes_[slot]) <= sweep.radius_m * sweep.radius_m;
}

}  // namespace sidestep
