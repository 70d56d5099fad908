// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/trapezoidal_decomposition.hpp"

#include <algorithm>
#include <numbers>

#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {
namespace {

constexpr double kStandoff_m = 1e-6;
constexpr double kMinWidth_m = 1e-9;  // narrower slabs and portals are ignored

}  // namespace

double TrapezoidalDecomposition::Edge::y_at(double x) const {
  const double fraction = (x - left_m.x()) / (right_m.x() - left_m.x());
  return left_m.y() + fraction * (right_m.y() - left_m.y());
}

const Plan<Vec2>& TrapezoidalDecomposition::plan(const DiscDomain& domain, const Vec2& start,
                                                 const Budget& budget, Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  const double half_length_m = domain.field().length_m / 2 - domain.radius_m();
  const double half_width_m = domain.field().width_m / 2 - domain.radius_m();
  inflate_obstacles(domain);
  find_cuts(half_length_m);
  graph_.cells.clear();
  graph_.portals.clear();
  left_cells_.clear();
  for (std::size_t i = 1; i < cuts_.size(); ++i) fill_slab(cuts_[i - 1], cuts_[i], half_width_m);
  search_.plan(graph_, domain, start, budget, plan_);
  return plan_;
}

void TrapezoidalDecomposition::inflate_obstacles(const DiscDomain& domain) {
  edges_.clear();
  std::vector<TangentArc> arcs;
  std::vector<Vec2> vertices;
  for (const ObstacleId id : domain.world().obstacles()) {
    arcs.clear();
    vertices.clear();
    append_arcs(domain.world().shape(id), domain.radius_m() + kStandoff_m, arcs);
    for (const TangentArc& arc : arcs) {
      // Counter-clockwise along the arc, from its first direction.
      const Vec2 from = arc.is_corner ? left_of(arc.first) : Vec2(0, 1);
      const double arc_turn_rad =
          arc.is_corner ? turn_rad(Side::kLeft, arc.first, arc.last) : 2 * std::numbers::pi;
      append_vertices(arc, Side::kLeft, from, arc_turn_rad, settings_.vertex_turn_rad, vertices);
    }
    add_polygon(vertices);
  }
}

void TrapezoidalDecomposition::add_polygon(const std::vector<Vec2>& vertices) {
  for (std::size_t i = 0, last = vertices.size() - 1; i < vertices.size(); last = i++) {
    const Vec2 &from = vertices[last], &to = vertices[i];
    // The polygon is counter-clockwise, so its lower edges lead to the right.
    if (from.x() < to.x()) edges_.push_back({from, to, true});
    if (to.x() < from.x()) edges_.push_back({to, from, false});
  }
}

void TrapezoidalDecomposition::find_cuts(double half_length_m) {
  cuts_.assign({-half_length_m, half_length_m});
  const auto add = [&](double x) {
    if (std::abs(x) < half_length_m) cuts_.push_back(x);
  };
  std::sort(edges_.begin(), edges_.end(),
            [](const Edge& a, const Edge& b) { return a.left_m.x() < b.left_m.x(); });
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& a = edges_[i];
    add(a.left_m.x());
    add(a.right_m.x());
    for (std::size_t j = i + 1; j < edges_.size() && edges_[j].left_m.x() < a.right_m.x(); ++j) {
      const Edge& b = edges_[j];
      const Vec2 along_a = a.right_m - a.left_m, along_b = b.right_m - b.left_m;
      const double across = cross(along_a, along_b);
      if (across == 0) continue;
      const double part_a = cross(b.left_m - a.left_m, along_b) / across;
      const double part_b = cross(b.left_m - a.left_m, along_a) / across;
      if (part_a > 0 && part_a < 1 && part_b > 0 && part_b < 1) add(a.left_m.x() + part_a * along_a.x());
    }
  }
  std::sort(cuts_.begin(), cuts_.end());
  const auto is_same = [](double a, double b) { return b - a < kMinWidth_m; };
  cuts_.erase(std::unique(cuts_.begin(), cuts_.end(), is_same), cuts_.end());
}

/// Edges do not cross within a slab. From bottom to top, the parts covered by no polygon are free.
void TrapezoidalDecomposition::fill_slab(double left_m, double right_m, double half_width_m) {
  const double middle_m = (left_m + right_m) / 2;
  slab_edges_.clear();
  for (const Edge& edge : edges_) {
    if (edge.left_m.x() > middle_m) break;
    if (edge.right_m.x() > middle_m) slab_edges_.push_back(&edge);
  }
  std::sort(slab_edges_.begin(), slab_edges_.end(),
            [&](const Edge* a, const Edge* b) { return a->y_at(middle_m) < b->y_at(middle_m); });
  current_cells_.clear();
  int covered = 0;
  Vec2 low(-half_width_m, -half_width_m);  // lower bound of the free part at the left and at the right end
  const auto clamped = [&](double y) { return std::clamp(y, -half_width_m, half_width_m); };
  for (const Edge* edge : slab_edges_) {
    const Vec2 at(clamped(edge->y_at(left_m)), clamped(edge->y_at(right_m)));
    if (edge->is_lower && covered++ == 0) add_cell(left_m, right_m, low, at);
    if (!edge->is_lower && --covered == 0) low = at;
  }
  if (covered == 0) add_cell(left_m, right_m, low, {half_width_m, half_width_m});
  std::swap(left_cells_, current_cells_);
}

void TrapezoidalDecomposition::add_cell(double left_m, double right_m, const Vec2& low_m,
                                        const Vec2& high_m) {
  if (high_m.x() - low_m.x() + high_m.y() - low_m.y() < kMinWidth_m) return;
  const auto index = static_cast<std::uint32_t>(graph_.cells.size());
  graph_.cells.push_back(
      {{{left_m, low_m.x()}, {right_m, low_m.y()}, {right_m, high_m.y()}, {left_m, high_m.x()}}});
  for (const Cell& other : left_cells_) {
    const double low = std::max(other.right_low_m, low_m.x()),
                 high = std::min(other.right_high_m, high_m.x());
    if (high - low > kMinWidth_m) graph_.portals.push_back({other.index, index, {left_m, (low + high) / 2}});
  }
  current_cells_.push_back({index, low_m.y(), high_m.y()});
}

}  // namespace sidestep
