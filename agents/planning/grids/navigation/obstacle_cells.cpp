// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/navigation/obstacle_cells.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "agents/planning/grids/navigation/blocked_cells.hpp"

namespace sidestep {
namespace {

bool is_same(const Circle& a, const Circle& b) {
  return a.centre_m == b.centre_m && a.radius_m == b.radius_m;
}
bool is_same(const Box& a, const Box& b) { return a.min_m == b.min_m && a.max_m == b.max_m; }
bool is_same(const Segment& a, const Segment& b) { return a.from_m == b.from_m && a.to_m == b.to_m; }
bool is_same(const ConvexPolygon& a, const ConvexPolygon& b) { return a.corners_m == b.corners_m; }

bool is_same_shape(const Shape& a, const Shape& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& shape) { return is_same(shape, std::get<std::decay_t<decltype(shape)>>(b)); }, a);
}

}  // namespace

ObstacleCells::ObstacleCells(const GridLayout& layout, double radius_m)
    : layout_(layout), radius_m_(radius_m) {
  check(layout);
  if (!(radius_m >= 0) || !std::isfinite(radius_m))
    throw std::invalid_argument("the radius of a disc must be finite and not negative");
  obstacles_on_.assign(layout.size(), 0);
}

void ObstacleCells::update(const ObstacleWorld& world) {
  ++updates_;
  changed_cells_.clear();
  changed_bounds_.clear();
  for (std::size_t i = 0; i < world.size(); ++i) {
    const ObstacleId id = world.obstacle(i);
    const auto index = static_cast<std::size_t>(id);
    if (index >= known_.size()) known_.resize(index + 1);
    Known& known = known_[index];
    const Shape& shape = world.shape(id);
    if (known.seen_at == 0 || !is_same_shape(known.shape, shape)) {
      remove(known);
      add(known, shape);
    }
    known.seen_at = updates_;
  }
  for (Known& known : known_)
    if (known.seen_at != updates_) remove(known);
}

void ObstacleCells::add(Known& known, const Shape& shape) {
  known.shape = shape;
  find_blocked_cells(layout_, shape, radius_m_, known.cells);
  for (const GridCell cell : known.cells)
    if (obstacles_on_[cell]++ == 0) changed_cells_.push_back(cell);
  changed_bounds_.push_back(bounds(shape));
}

void ObstacleCells::remove(Known& known) {
  if (known.seen_at == 0) return;
  for (const GridCell cell : known.cells)
    if (--obstacles_on_[cell] == 0) changed_cells_.push_back(cell);
  changed_bounds_.push_back(bounds(known.shape));
  known.seen_at = 0;
}

}  // namespace sidestep
