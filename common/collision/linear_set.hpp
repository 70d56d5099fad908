// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/shape_store.hpp"

namespace sidestep {

/// All obstacles in arrays, compared in vector lanes: circles exactly, other shapes by their boxes first.
class LinearSet {
 public:
  explicit LinearSet(const ShapeStore& store);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  collision::LinearView view() const {
    return {circles_.data(), circles_.size(), boxes_.data(), boxes_.size(), box_slots_.data()};
  }

 private:
  /// The lane of a slot in the circle blocks or the box blocks.
  struct Location {
    std::uint32_t lane = 0;
    bool is_circle = false;
  };

  void put(Location location, const Shape& shape);
  void clear(Location location);

  Vec2 origin_m_;
  std::vector<collision::CircleBlock> circles_;
  std::vector<collision::BoxBlock> boxes_;
  std::vector<Slot> circle_slots_, box_slots_;  // indexed by lane
  std::vector<Location> locations_;             // indexed by slot
};

}  // namespace sidestep
