// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/collision/bodies.hpp"

namespace sidestep {

/// All obstacles side by side, to be compared as many at once as the machine's vectors hold: circles
/// themselves, of other shapes the boxes first.
class LinearSet {
 public:
  explicit LinearSet(const Bodies& bodies);

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  collision::LinearView view() const {
    return {circles_.data(), circles_.size(), boxes_.data(), boxes_.size(), box_slots_.data()};
  }

 private:
  /// Which lane of the circles or of the boxes a slot has.
  struct Place {
    std::uint32_t lane = 0;
    bool is_circle = false;
  };

  void put(Place place, const Shape& shape);
  void clear(Place place);

  Vec2 origin_m_;
  std::vector<collision::CircleBlock> circles_;
  std::vector<collision::BoxBlock> boxes_;
  std::vector<Slot> circle_slots_, box_slots_;  // by lane
  std::vector<Place> places_;                   // by slot
};

}  // namespace sidestep
