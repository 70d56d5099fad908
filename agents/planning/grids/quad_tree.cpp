// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/quad_tree.hpp"

#include <algorithm>

namespace sidestep {
namespace {

/// The side of the smallest cell is the longer side of the free area / 2^depth.
constexpr int kTreeDepth = 8;

constexpr std::uint32_t kNone = 0xffffffff;

}  // namespace

const Plan<Vec2>& QuadTree::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  side_ = 1 << kTreeDepth;
  const double x = domain.field().length_m - 2 * domain.radius_m(),
               y = domain.field().width_m - 2 * domain.radius_m();
  unit_m_ = std::max(x, y) / side_;
  origin_m_ = {-x / 2, -y / 2};
  graph_.cells.clear();
  graph_.portals.clear();
  squares_.clear();
  cell_at_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), kNone);
  subdivide(domain, 0, 0, side_);
  join_neighbours();
  search_.plan(graph_, domain, start, budget, plan_);
  return plan_;
}

void QuadTree::subdivide(const DiscDomain& domain, int x, int y, int size) {
  const double half_m = size * unit_m_ / 2, circumradius_m = half_m * std::sqrt(2.0) * (1 + 1e-9);
  const Vec2 centre = origin_m_ + unit_m_ * Vec2(x, y) + Vec2(half_m, half_m);
  const bool is_inside = domain.field().contains(centre, domain.radius_m() + half_m - 1e-9);
  if (is_inside && !domain.world().touches(centre, domain.radius_m() + circumradius_m))
    return add_cell(x, y, size);
  // If even a disc that is smaller by the circumradius touches at the centre, the whole square is blocked.
  const bool is_blocked = circumradius_m < domain.radius_m() &&
                          domain.world().touches(centre, domain.radius_m() - circumradius_m);
  if (size == 1 || is_blocked) return;
  for (const int dx : {0, size / 2})
    for (const int dy : {0, size / 2}) subdivide(domain, x + dx, y + dy, size / 2);
}

void QuadTree::add_cell(int x, int y, int size) {
  const auto cell = static_cast<std::uint32_t>(graph_.cells.size());
  const Vec2 low = origin_m_ + unit_m_ * Vec2(x, y), high = low + unit_m_ * Vec2(size, size);
  graph_.cells.push_back({{low, {high.x(), low.y()}, high, {low.x(), high.y()}}});
  squares_.push_back({x, y, size});
  for (int i = x; i < x + size; ++i)
    for (int j = y; j < y + size; ++j) cell_at_[index(i, j)] = cell;
}

void QuadTree::join_neighbours() {
  for (const Square& square : squares_) {
    join(square.x, square.y, square.size, false);
    join(square.x, square.y, square.size, true);
  }
}

/// Joins a square with the cells beyond its upper or right side.
void QuadTree::join(int x, int y, int size, bool upwards) {
  const int beyond = (upwards ? y : x) + size;
  if (beyond == side_) return;
  const std::uint32_t cell = cell_at_[index(x, y)];
  const int first = upwards ? x : y;
  for (int from = first, to = first; from < first + size; from = to) {
    const auto at = [&](int i) { return cell_at_[upwards ? index(i, beyond) : index(beyond, i)]; };
    for (to = from + 1; to < first + size && at(to) == at(from);) ++to;
    if (at(from) == kNone) continue;
    const double middle = (from + to) / 2.0;
    const Vec2 position = upwards ? Vec2(middle, beyond) : Vec2(beyond, middle);
    graph_.portals.push_back({cell, at(from), origin_m_ + unit_m_ * position});
  }
}

}  // namespace sidestep
