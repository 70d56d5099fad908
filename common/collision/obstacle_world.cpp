// SPDX-License-Identifier: Apache-2.0
#include "common/collision/obstacle_world.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "common/collision/batch/dispatch.hpp"

namespace sidestep {
namespace {

using collision::Answer;

constexpr std::size_t kMostInLine = 32, kMostInMasks = 1024;

std::vector<Shape> checked(std::vector<Shape> shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    try {
      check(shapes[i]);
    } catch (const std::invalid_argument& wrong) {
      throw std::invalid_argument("obstacle " + std::to_string(i) + ": " + wrong.what());
    }
  }
  return shapes;
}

}  // namespace

ObstacleWorld::ObstacleWorld(std::vector<Shape> shapes, Structure structure)
    : ObstacleWorld(std::move(shapes), structure, collision::best_kernels()) {}

ObstacleWorld::ObstacleWorld(std::vector<Shape> shapes, Structure structure,
                             const collision::Kernels& kernels)
    : kernels_(&kernels),
      structure_(structure),
      bodies_(checked(std::move(shapes))),
      set_(set_of(bodies_, structure)),
      size_when_built_(size()) {}

ObstacleWorld::Sets ObstacleWorld::set_of(const Bodies& bodies, Structure structure) {
  const std::size_t size = bodies.slots().size();
  if (structure == Structure::kAutomatic)
    structure = size <= kMostInLine    ? Structure::kLinear
                : size <= kMostInMasks ? Structure::kMasks
                                       : Structure::kTree;
  if (structure == Structure::kLinear) return LinearSet(bodies);
  if (structure == Structure::kMasks) return ExtentMasks(bodies);
  return BoxTree(bodies);
}

bool ObstacleWorld::touches(const Vec2& from, const Vec2& to, double radius) const {
  const collision::BodiesView bodies = bodies_.view();
  Answer answer = Answer::kInDoubt;
  if (const auto* masks = std::get_if<ExtentMasks>(&set_))
    answer = kernels_->masks(masks->view(), bodies, from.data(), to.data(), radius);
  else if (const auto* line = std::get_if<LinearSet>(&set_))
    answer = kernels_->linear(line->view(), bodies, from.data(), to.data(), radius);
  else
    answer = kernels_->tree(std::get_if<BoxTree>(&set_)->view(), bodies, from.data(), to.data(), radius);
  if (answer == Answer::kInDoubt) [[unlikely]]
    return touches_exactly(Sweep(from, to, radius));
  return answer == Answer::kTouches;
}

bool ObstacleWorld::touches_exactly(const Sweep& sweep) const {
  return std::any_of(bodies_.slots().begin(), bodies_.slots().end(),
                     [&](Slot slot) { return bodies_.touches(slot, sweep); });
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
  if (size() <= 2 * size_when_built_ + kMostInLine) {
    std::visit([&](auto& set) { set.add(slot, bodies_.shape(slot)); }, set_);
  } else {
    set_ = set_of(bodies_, structure_);
    size_when_built_ = size();
  }
  return ObstacleId{slot};
}

void ObstacleWorld::move(ObstacleId obstacle, const Vec2& by) {
  const Slot slot = slot_of(obstacle);
  Shape shape = moved(bodies_.shape(slot), by);
  if (!is_near_enough(bounds(shape)))
    throw std::invalid_argument("an obstacle would be moved farther than 1e15 m from the origin");
  bodies_.replace(slot, std::move(shape));
  std::visit([&](auto& set) { set.replace(slot, bodies_.shape(slot)); }, set_);
}

void ObstacleWorld::remove(ObstacleId obstacle) {
  const Slot slot = slot_of(obstacle);
  std::visit([&](auto& set) { set.remove(slot); }, set_);
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
