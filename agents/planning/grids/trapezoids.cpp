// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/trapezoids.hpp"

#include <algorithm>

#include "agents/planning/visibility/bend.hpp"

namespace sidestep {
namespace {

constexpr double kStandOff_m = 1e-6;
constexpr double kNarrowest_m = 1e-9;  // strips and borders that are narrower are none
constexpr double kFull_rad = 6.283185307179586;

}  // namespace

double Trapezoids::Edge::y_at(double x) const {
  const double part = (x - left_m.x()) / (right_m.x() - left_m.x());
  return left_m.y() + part * (right_m.y() - left_m.y());
}

const Plan<Vec2>& Trapezoids::plan(const DiscDomain& domain, const Vec2& start, const Budget& budget, Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  const double half_length_m = domain.field().length_m / 2 - domain.radius_m();
  const double half_width_m = domain.field().width_m / 2 - domain.radius_m();
  grow_obstacles(domain);
  cut(half_length_m);
  graph_.cells.clear();
  graph_.portals.clear();
  before_.clear();
  for (std::size_t i = 1; i < cuts_.size(); ++i) fill_strip(cuts_[i - 1], cuts_[i], half_width_m);
  search_.plan(graph_, domain, start, budget, plan_);
  return plan_;
}

void Trapezoids::grow_obstacles(const DiscDomain& domain) {
  edges_.clear();
  std::vector<Bend> bends;
  std::vector<Vec2> corners;
  for (const ObstacleId id : domain.world().obstacles()) {
    bends.clear();
    corners.clear();
    append_bends(domain.world().shape(id), domain.radius_m() + kStandOff_m, bends);
    for (const Bend& bend : bends) {
      // Along the border counter-clockwise: from where it touches the first direction on.
      const Vec2 from = bend.is_corner ? left_of(bend.first) : Vec2(0, 1);
      const double turn = bend.is_corner ? turn_rad(Side::kLeft, bend.first, bend.last) : kFull_rad;
      append_corners(bend, Side::kLeft, from, turn, settings_.corner_rad, corners);
    }
    add_polygon(corners);
  }
}

void Trapezoids::add_polygon(const std::vector<Vec2>& corners) {
  for (std::size_t i = 0, last = corners.size() - 1; i < corners.size(); last = i++) {
    const Vec2 &from = corners[last], &to = corners[i];
    // Counter-clockwise, the lower border leads to the right.
    if (from.x() < to.x()) edges_.push_back({from, to, true});
    if (to.x() < from.x()) edges_.push_back({to, from, false});
  }
}

void Trapezoids::cut(double half_length_m) {
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
  const auto is_same = [](double a, double b) { return b - a < kNarrowest_m; };
  cuts_.erase(std::unique(cuts_.begin(), cuts_.end(), is_same), cuts_.end());
}

/// Edges do not cross within a strip: from below, what no polygon covers is free.
void Trapezoids::fill_strip(double left_m, double right_m, double half_width_m) {
  const double middle_m = (left_m + right_m) / 2;
  strip_.clear();
  for (const Edge& edge : edges_) {
    if (edge.left_m.x() > middle_m) break;
    if (edge.right_m.x() > middle_m) strip_.push_back(&edge);
  }
  std::sort(strip_.begin(), strip_.end(),
            [&](const Edge* a, const Edge* b) { return a->y_at(middle_m) < b->y_at(middle_m); });
  now_.clear();
  int covered = 0;
  Vec2 low(-half_width_m, -half_width_m);  // of the free part, on the left and on the right
  const auto inside = [&](double y) { return std::clamp(y, -half_width_m, half_width_m); };
  for (const Edge* edge : strip_) {
    const Vec2 at(inside(edge->y_at(left_m)), inside(edge->y_at(right_m)));
    if (edge->is_lower && covered++ == 0) add_cell(left_m, right_m, low, at);
    if (!edge->is_lower && --covered == 0) low = at;
  }
  if (covered == 0) add_cell(left_m, right_m, low, {half_width_m, half_width_m});
  std::swap(before_, now_);
}

void Trapezoids::add_cell(double left_m, double right_m, const Vec2& low_m, const Vec2& high_m) {
  if (high_m.x() - low_m.x() + high_m.y() - low_m.y() < kNarrowest_m) return;
  const auto number = static_cast<std::uint32_t>(graph_.cells.size());
  graph_.cells.push_back(
      {{{left_m, low_m.x()}, {right_m, low_m.y()}, {right_m, high_m.y()}, {left_m, high_m.x()}}});
  for (const Cell& other : before_) {
    const double low = std::max(other.right_low_m, low_m.x()),
                 high = std::min(other.right_high_m, high_m.x());
    if (high - low > kNarrowest_m)
      graph_.portals.push_back({other.number, number, {left_m, (low + high) / 2}});
  }
  now_.push_back({number, low_m.y(), high_m.y()});
}

}  // namespace sidestep
