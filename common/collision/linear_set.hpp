// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/collision/batch/dispatch.hpp"
#include "common/collision/bodies.hpp"

namespace sidestep {

/// Compares a query with every obstacle, as many at once as the machine's vectors hold: circles themselves,
/// the boxes of other shapes first. Single precision with a bound for its error decides; what is within that
/// is compared exactly.
class LinearSet {
 public:
  explicit LinearSet(const Bodies& bodies, const collision::Kernels& kernels = collision::best_kernels());

  void add(Slot slot, const Shape& shape);
  void replace(Slot slot, const Shape& shape);
  void remove(Slot slot);

  bool touches(const Sweep& sweep, const Bodies& bodies) const;

 private:
  /// Which lane of the circles or of the boxes a slot has.
  struct Place {
    std::uint32_t lane = 0;
    bool is_circle = false;
  };

  void put(Place place, const Shape& shape);
  void clear(Place place);
  bool touches_exactly(const Sweep& sweep, const Bodies& bodies) const;
  bool touches_others(const Sweep& sweep, const Bodies& bodies) const;

  const collision::Kernels* kernels_;
  Vec2 origin_m_;
  double farthest_m_ = 0, largest_radius_m_ = 0;  // from the origin; of a circle
  std::vector<collision::CircleBlock> circles_;
  std::vector<collision::BoxBlock> boxes_;
  std::vector<Slot> circle_slots_, box_slots_;  // by lane
  std::vector<Place> places_;                   // by slot
};

}  // namespace sidestep
