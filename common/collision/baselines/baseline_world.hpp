// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stdexcept>

#include "common/collision/obstacle_world.hpp"
#include "common/collision/shape_store.hpp"
#include "common/collision/time_of_impact.hpp"

namespace sidestep::baselines {

/// Answers the queries of ObstacleWorld with a textbook structure for comparison: `Set` finds candidates,
/// which are compared one by one in double precision. Throws std::invalid_argument in the same cases as
/// ObstacleWorld.
template <typename Set>
class BaselineWorld {
 public:
  explicit BaselineWorld(std::vector<Shape> shapes = {}) : store_(checked(std::move(shapes))), set_(store_) {}

  bool touches(const Vec2& at_m, double radius_m) const { return touches(at_m, at_m, radius_m); }
  bool touches(const Vec2& from_m, const Vec2& to_m, double radius_m) const {
    const Sweep sweep(from_m, to_m, radius_m);
    return set_.any_candidate(sweep, [&](Slot slot) { return store_.touches(slot, sweep); });
  }
  std::optional<Contact> first_contact(const Vec2& from_m, const Vec2& to_m, double radius_m) const {
    const Sweep sweep(from_m, to_m, radius_m);
    std::optional<Contact> first;
    set_.any_candidate(sweep, [&](Slot slot) {
      const std::optional<double> fraction = time_of_impact(sweep, store_.shape(slot));
      if (fraction && !(first && first->fraction <= *fraction)) first = Contact{*fraction, ObstacleId{slot}};
      return false;
    });
    return first;
  }

  ObstacleId add(Shape shape) {
    check(shape);
    const Slot slot = store_.add(std::move(shape));
    set_.add(slot, store_.shape(slot));
    return ObstacleId{slot};
  }
  void move(ObstacleId obstacle, const Vec2& by_m) {
    const Slot slot = slot_of(obstacle);
    Shape shape = moved(store_.shape(slot), by_m);
    check(shape);
    store_.replace(slot, std::move(shape));
    set_.replace(slot, store_.shape(slot));
  }
  void remove(ObstacleId obstacle) {
    const Slot slot = slot_of(obstacle);
    set_.remove(slot);
    store_.remove(slot);
  }

  std::size_t size() const { return store_.slots().size(); }
  const Shape& shape(ObstacleId obstacle) const { return store_.shape(slot_of(obstacle)); }
  /// The i-th of size() obstacles, in no particular order.
  ObstacleId obstacle(std::size_t i) const { return ObstacleId{store_.slots()[i]}; }

 private:
  static std::vector<Shape> checked(std::vector<Shape> shapes) {
    for (const Shape& shape : shapes) check(shape);
    return shapes;
  }
  Slot slot_of(ObstacleId obstacle) const {
    const auto slot = static_cast<Slot>(obstacle);
    if (!store_.has(slot)) throw std::invalid_argument("there is no obstacle " + std::to_string(slot));
    return slot;
  }

  ShapeStore store_;
  Set set_;
};

}  // namespace sidestep::baselines
