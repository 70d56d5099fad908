// SPDX-License-Identifier: Apache-2.0
#include "common/collision/obstacle_world.hpp"

#include <stdexcept>
#include <string>

namespace sidestep {
namespace {

Bodies bodies_of(std::vector<Shape>&& shapes) {
  Bodies bodies;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    try {
      check(shapes[i]);
    } catch (const std::invalid_argument& wrong) {
      throw std::invalid_argument("obstacle " + std::to_string(i) + ": " + wrong.what());
    }
    bodies.add(std::move(shapes[i]));
  }
  return bodies;
}

}  // namespace

ObstacleWorld::ObstacleWorld(std::vector<Shape> shapes, Structure)
    : bodies_(bodies_of(std::move(shapes))), linear_(bodies_) {}

bool ObstacleWorld::touches(const Vec2& from, const Vec2& to, double radius) const {
  return linear_.touches(Sweep(from, to, radius), bodies_);
}

Nearest ObstacleWorld::nearest(const Vec2& at) const {
  if (!at.allFinite()) throw std::invalid_argument("a place from which the nearest is asked is not finite");
  Nearest nearest;
  for (const Slot slot : bodies_.slots()) {
    const double distance_m = signed_distance(at, bodies_.shape(slot));
    if (distance_m < nearest.distance_m) nearest = {distance_m, ObstacleId{slot}};
  }
  return nearest;
}

ObstacleId ObstacleWorld::add(Shape shape) {
  check(shape);
  const Slot slot = bodies_.add(std::move(shape));
  linear_.add(slot, bodies_.shape(slot));
  return ObstacleId{slot};
}

void ObstacleWorld::move(ObstacleId obstacle, const Vec2& by) {
  const Slot slot = slot_of(obstacle);
  Shape shape = moved(bodies_.shape(slot), by);
  const Box box = bounds(shape);
  if (!box.min_m.allFinite() || !box.max_m.allFinite())
    throw std::invalid_argument("an obstacle would be moved to where numbers are not finite");
  bodies_.replace(slot, std::move(shape));
  linear_.replace(slot, bodies_.shape(slot));
}

void ObstacleWorld::remove(ObstacleId obstacle) {
  const Slot slot = slot_of(obstacle);
  linear_.remove(slot);
  bodies_.remove(slot);
}

const Shape& ObstacleWorld::shape(ObstacleId obstacle) const { return bodies_.shape(slot_of(obstacle)); }

std::vector<ObstacleId> ObstacleWorld::obstacles() const {
  std::vector<ObstacleId> ids;
  ids.reserve(size());
  for (const Slot slot : bodies_.slots()) ids.push_back(ObstacleId{slot});
  return ids;
}

Slot ObstacleWorld::slot_of(ObstacleId obstacle) const {
  if (!has(obstacle))
    throw std::invalid_argument("there is no obstacle " + std::to_string(static_cast<Slot>(obstacle)));
  return static_cast<Slot>(obstacle);
}

}  // namespace sidestep
