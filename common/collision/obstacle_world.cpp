// SPDX-License-Identifier: Apache-2.0
#include "common/collision/obstacle_world.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "common/collision/batch/dispatch.hpp"
#include "common/collision/time_of_impact.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxLinear = 8, kMaxMasks = 512;

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

using Sets = std::variant<LinearSet, ExtentMasks, BoxTree>;

Sets set_of(const ShapeStore& store, Structure structure) {
  const std::size_t size = store.slots().size();
  if (structure == Structure::kAutomatic)
    structure = size <= kMaxLinear  ? Structure::kLinear
                : size <= kMaxMasks ? Structure::kMasks
                                    : Structure::kTree;
  if (structure == Structure::kLinear) return LinearSet(store);
  if (structure == Structure::kMasks) return ExtentMasks(store);
  return BoxTree(store);
}

}  // namespace

ObstacleWorld::ObstacleWorld(std::vector<Shape> shapes, Structure structure)
    : ObstacleWorld(std::move(shapes), structure, collision::best_kernels()) {}

ObstacleWorld::ObstacleWorld(std::vector<Shape> shapes, Structure structure,
                             const collision::Kernels& kernels)
    : ObstacleWorld([&] {
        ShapeStore store(checked(std::move(shapes)));
        auto set = set_of(store, structure);
        const std::size_t size = store.slots().size();
        return Parts{&kernels, structure, std::move(store), std::move(set), size};
      }()) {}

ObstacleWorld::ObstacleWorld(Parts parts) : parts_(std::move(parts)) { update_view(); }

ObstacleWorld& ObstacleWorld::operator=(const ObstacleWorld& other) {
  parts_ = other.parts_;
  update_view();
  return *this;
}

void ObstacleWorld::update_view() {
  view_.shapes = parts_.store.view();
  if (const auto* linear = std::get_if<LinearSet>(&parts_.set)) {
    view_.linear = linear->view();
    sweep_ = parts_.kernels->linear;
  } else if (const auto* masks = std::get_if<ExtentMasks>(&parts_.set)) {
    view_.masks = masks->view();
    sweep_ = view_.masks.words == 1 ? parts_.kernels->one_word_masks : parts_.kernels->masks;
  } else {
    view_.tree = std::get<BoxTree>(parts_.set).view();
    sweep_ = parts_.kernels->tree;
  }
}

bool ObstacleWorld::touches_exactly(const Vec2& from, const Vec2& to, double radius) const {
  const Sweep sweep(from, to, radius);
  if (!overlap(sweep.bounds(), parts_.store.bounds_m())) return false;
  const std::vector<Slot>& slots = parts_.store.slots();
  return std::any_of(slots.begin(), slots.end(),
                     [&](Slot slot) { return parts_.store.touches(slot, sweep); });
}

std::optional<Contact> ObstacleWorld::first_contact(const Vec2& from, const Vec2& to, double radius) const {
  const Sweep sweep(from, to, radius);
  const Box box = sweep.bounds();
  std::optional<Contact> first;
  const auto consider = [&](Slot slot) {
    const std::optional<double> fraction = time_of_impact(sweep, parts_.store.shape(slot));
    if (fraction && !(first && first->fraction <= *fraction)) first = Contact{*fraction, ObstacleId{slot}};
  };
  if (const auto* masks = std::get_if<ExtentMasks>(&parts_.set))
    masks->each_overlapping(box, consider);
  else if (const auto* tree = std::get_if<BoxTree>(&parts_.set))
    tree->each_overlapping(box, consider);
  else
    for (const Slot slot : parts_.store.slots())
      if (overlap(bounds(parts_.store.shape(slot)), box)) consider(slot);
  return first;
}

Nearest ObstacleWorld::nearest(const Vec2& at) const {
  if (!at.allFinite()) throw std::invalid_argument("the position of a nearest-obstacle query is not finite");
  const auto* tree = std::get_if<BoxTree>(&parts_.set);
  const NearestSlot nearest = tree != nullptr ? tree->nearest(at, parts_.store) : parts_.store.nearest(at);
  return {nearest.distance_m, ObstacleId{nearest.slot}};
}

ObstacleId ObstacleWorld::add(Shape shape) {
  check(shape);
  const Slot slot = parts_.store.add(std::move(shape));
  if (size() <= 2 * parts_.size_when_built + kMaxLinear) {
    std::visit([&](auto& set) { set.add(slot, parts_.store.shape(slot)); }, parts_.set);
  } else {
    parts_.set = set_of(parts_.store, parts_.structure);
    parts_.size_when_built = size();
  }
  update_view();
  return ObstacleId{slot};
}

void ObstacleWorld::move(ObstacleId obstacle, const Vec2& by) {
  const Slot slot = slot_of(obstacle);
  Shape shape = moved(parts_.store.shape(slot), by);
  if (!is_in_range(bounds(shape)))
    throw std::invalid_argument("an obstacle would be moved farther than 1e15 m from the origin");
  parts_.store.replace(slot, std::move(shape));
  std::visit([&](auto& set) { set.replace(slot, parts_.store.shape(slot)); }, parts_.set);
  update_view();
}

void ObstacleWorld::remove(ObstacleId obstacle) {
  const Slot slot = slot_of(obstacle);
  std::visit([&](auto& set) { set.remove(slot); }, parts_.set);
  parts_.store.remove(slot);
  update_view();
}

const Shape& ObstacleWorld::shape(ObstacleId obstacle) const { return parts_.store.shape(slot_of(obstacle)); }

std::vector<ObstacleId> ObstacleWorld::obstacles() const {
  std::vector<ObstacleId> ids;
  ids.reserve(size());
  for (const Slot slot : parts_.store.slots()) ids.push_back(ObstacleId{slot});
  return ids;
}

Slot ObstacleWorld::slot_of(ObstacleId obstacle) const {
  if (!has(obstacle))
    throw std::invalid_argument("there is no obstacle " + std::to_string(static_cast<Slot>(obstacle)));
  return static_cast<Slot>(obstacle);
}

}  // namespace sidestep
