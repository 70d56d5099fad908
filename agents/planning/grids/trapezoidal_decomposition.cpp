// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/grids/trapezoidal_decomposition.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "agents/planning/visibility/tangent_arc.hpp"

namespace sidestep {
namespace {

/// Maximum turn at a vertex of the polygons that approximate arcs.
constexpr double kTrapezoidTurn_rad = 0.2;
constexpr std::uint64_t kOrderSeed = 1;  ///< seed of the random order in which the map is built

using Index = TrapezoidalMap::Index;

constexpr std::int32_t kMargin = 16;      // margin of the box around the field, in grid units
constexpr double kStandoff_m = 1e-6;      // clearance beyond the radius, unless kStandoff_units is longer
constexpr double kStandoff_units = 4;     // in grid units; rounding moves boundaries by about one unit
constexpr double kMinPortalHeight = 0.5;  // minimum length of a portal, in grid units
constexpr std::int32_t kUnknown = std::numeric_limits<std::int32_t>::min();

/// The part of a convex polygon where sign * coordinate <= limit.
void clip(std::vector<Vec2>& vertices, Eigen::Index axis, double sign, double limit_m) {
  std::vector<Vec2> clipped;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 &from = vertices[i], &to = vertices[(i + 1) % vertices.size()];
    const double from_m = sign * from[axis] - limit_m, to_m = sign * to[axis] - limit_m;
    if (from_m <= 0) clipped.push_back(from);
    if ((from_m < 0 && to_m > 0) || (from_m > 0 && to_m < 0))
      clipped.push_back(from + from_m / (from_m - to_m) * (to - from));
  }
  vertices = clipped;
}

}  // namespace

const Plan<Vec2>& TrapezoidalDecomposition::plan(const DiscDomain& domain, const Vec2& start,
                                                 const Budget& budget, Rng&) {
  begin_plan(domain, start, plan_);
  if (plan_straight(domain, start, plan_)) return plan_;
  graph_.cells.clear();
  graph_.portals.clear();
  walls_.clear();
  cell_of_.clear();
  if (choose_grid(domain)) {
    add_boundaries(domain);
    // Without a trapezoidal map there are no cells, so the goal is unreachable for this planner.
    if (divider_.divide(boundaries_)) add_cells();
  }
  search_.plan(graph_, domain, start, budget, plan_, {cell_at(start), cell_at(domain.goal(start))});
  if (plan_.arrives()) shorten(domain, start);
  return plan_;
}

std::optional<std::uint32_t> TrapezoidalDecomposition::cell_at(const Vec2& position) const {
  if (cell_of_.empty()) return std::nullopt;
  const GridPoint point = rounded(position);
  if (std::abs(point.x) > half_field_.x || std::abs(point.y) > half_field_.y) return std::nullopt;
  const std::uint32_t cell = cell_of_[map_.locate(point).trapezoid];
  return cell == TrapezoidalMap::kNone ? std::nullopt : std::optional(cell);
}

bool TrapezoidalDecomposition::choose_grid(const DiscDomain& domain) {
  const Vec2 half_m(domain.field().length_m / 2 - domain.radius_m(),
                    domain.field().width_m / 2 - domain.radius_m());
  if (!(half_m.minCoeff() > 0)) return false;
  unit_m_ = half_m.maxCoeff() / (kMaxGridCoordinate - 2 * kMargin);
  // Rounded inwards: paths along the border must stay within the field.
  half_field_ = {static_cast<std::int32_t>(half_m.x() / unit_m_),
                 static_cast<std::int32_t>(half_m.y() / unit_m_)};
  return true;
}

GridPoint TrapezoidalDecomposition::rounded(const Vec2& position) const {
  const auto coordinate = [&](double at_m) {
    constexpr double kMax = kMaxGridCoordinate;
    return static_cast<std::int32_t>(std::lround(std::clamp(at_m / unit_m_, -kMax, kMax)));
  };
  return {coordinate(position.x()), coordinate(position.y())};
}

void TrapezoidalDecomposition::add_boundaries(const DiscDomain& domain) {
  boundaries_.clear();
  // Clockwise: the outside counts as covered.
  const auto [x, y] = half_field_;
  CrossingDivider::append_boundary(std::array<GridPoint, 4>{GridPoint{-x, -y}, {-x, y}, {x, y}, {x, -y}},
                                   boundaries_);
  const double clearance_m = domain.radius_m() + std::max(kStandoff_m, kStandoff_units * unit_m_);
  std::vector<TangentArc> arcs;
  std::vector<Vec2> vertices;
  for (const ObstacleId id : domain.world().obstacles()) {
    arcs.clear();
    vertices.clear();
    append_arcs(domain.world().shape(id), clearance_m, arcs);
    for (const TangentArc& arc : arcs) {
      // Runs counter-clockwise along the arc, starting at its first direction.
      const Vec2 from = arc.is_corner ? left_of(arc.first) : Vec2(0, 1);
      const double arc_turn_rad =
          arc.is_corner ? turn_rad(Side::kLeft, arc.first, arc.last) : 2 * std::numbers::pi;
      append_vertices(arc, Side::kLeft, from, arc_turn_rad, kTrapezoidTurn_rad, vertices);
    }
    add_polygon(vertices);
  }
}

/// Adds the part of a polygon within a box slightly larger than the field.
void TrapezoidalDecomposition::add_polygon(const std::vector<Vec2>& vertices_m) {
  const Vec2 half_m = in_metres(half_field_.x + kMargin, half_field_.y + kMargin);
  std::vector<Vec2> clipped = vertices_m;
  for (const Eigen::Index axis : {0, 1})
    for (const double sign : {-1.0, 1.0}) clip(clipped, axis, sign, half_m[axis]);
  std::vector<GridPoint> corners;
  corners.reserve(clipped.size());
  for (const Vec2& vertex : clipped) corners.push_back(rounded(vertex));
  CrossingDivider::append_boundary(corners, boundaries_);
}

void TrapezoidalDecomposition::add_cells() {
  segments_.clear();
  for (const WindingSegment& boundary : boundaries_) segments_.push_back(boundary.segment);
  Rng order(kOrderSeed);
  map_.build(segments_, {half_field_.x + 2 * kMargin, half_field_.y + 2 * kMargin}, order);
  count_covers();
  cell_of_.assign(map_.trapezoids().size(), TrapezoidalMap::kNone);
  for (Index i = 0; i < map_.trapezoids().size(); ++i)
    if (covers_[i] == 0) add_cell(i);
  for (Index i = 0; i < map_.trapezoids().size(); ++i)
    if (cell_of_[i] != TrapezoidalMap::kNone) add_portals(i);
}

/// Starts at the bottom of the box, which is outside the field, and continues through neighbours and across
/// segments.
void TrapezoidalDecomposition::count_covers() {
  above_.assign(map_.segments().size(), TrapezoidalMap::kNone);
  below_.assign(map_.segments().size(), TrapezoidalMap::kNone);
  for (Index i = 0; i < map_.trapezoids().size(); ++i) {
    const TrapezoidalMap::Trapezoid& trapezoid = map_.trapezoids()[i];
    if (trapezoid.leaf == TrapezoidalMap::kNone) continue;
    above_[trapezoid.bottom] = i;
    below_[trapezoid.top] = i;
  }
  covers_.assign(map_.trapezoids().size(), kUnknown);
  open_.clear();
  cover(above_[map_.box_bottom()], 1);
  while (!open_.empty()) {
    const Index at = open_.back();
    open_.pop_back();
    const TrapezoidalMap::Trapezoid& trapezoid = map_.trapezoids()[at];
    const std::int32_t count = covers_[at];
    for (const Index neighbour : trapezoid.left_neighbours) cover(neighbour, count);
    for (const Index neighbour : trapezoid.right_neighbours) cover(neighbour, count);
    if (trapezoid.top != map_.box_top())
      cover(above_[trapezoid.top], count + boundaries_[trapezoid.top].winding);
    if (trapezoid.bottom != map_.box_bottom())
      cover(below_[trapezoid.bottom], count - boundaries_[trapezoid.bottom].winding);
  }
}

/// Sets the count of a trapezoid and queues the trapezoid, unless the count is already known.
void TrapezoidalDecomposition::cover(Index trapezoid, std::int32_t count) {
  if (trapezoid == TrapezoidalMap::kNone || covers_[trapezoid] != kUnknown) return;
  covers_[trapezoid] = count;
  open_.push_back(trapezoid);
}

void TrapezoidalDecomposition::add_cell(Index i) {
  const TrapezoidalMap::Trapezoid& trapezoid = map_.trapezoids()[i];
  const GridSegment &bottom = map_.segments()[trapezoid.bottom], &top = map_.segments()[trapezoid.top];
  cell_of_[i] = static_cast<std::uint32_t>(graph_.cells.size());
  std::vector<Vec2>& corners = graph_.cells.emplace_back().corners_m;
  const GridPoint &left = trapezoid.left, &right = trapezoid.right;
  corners.reserve(4);
  for (const Vec2& corner : {in_metres(left.x, y_at(bottom, left)), in_metres(right.x, y_at(bottom, right)),
                             in_metres(right.x, y_at(top, right)), in_metres(left.x, y_at(top, left))})
    if (corners.empty() || (corner != corners.back() && corner != corners.front())) corners.push_back(corner);
}

/// Adds the portals from a trapezoid to the cells on its right.
void TrapezoidalDecomposition::add_portals(Index i) {
  const TrapezoidalMap::Trapezoid& trapezoid = map_.trapezoids()[i];
  const GridPoint& wall = trapezoid.right;
  for (const Index neighbour : trapezoid.right_neighbours) {
    if (neighbour == TrapezoidalMap::kNone || cell_of_[neighbour] == TrapezoidalMap::kNone) continue;
    const TrapezoidalMap::Trapezoid& other = map_.trapezoids()[neighbour];
    const double low =
        std::max(y_at(map_.segments()[trapezoid.bottom], wall), y_at(map_.segments()[other.bottom], wall));
    const double high =
        std::min(y_at(map_.segments()[trapezoid.top], wall), y_at(map_.segments()[other.top], wall));
    if (high - low <= kMinPortalHeight) continue;
    graph_.portals.push_back({cell_of_[i], cell_of_[neighbour], in_metres(wall.x, (low + high) / 2)});
    walls_.push_back({in_metres(wall.x, high), in_metres(wall.x, low)});
  }
}

void TrapezoidalDecomposition::shorten(const DiscDomain& domain, const Vec2& start) {
  const CellPath& path = search_.path();
  path_portals_.clear();
  for (const auto& [portal, cell] : path.steps) {
    path_portals_.push_back(walls_[portal]);
    // A portal's second cell is the cell on its right.
    if (cell != graph_.portals[portal].b)
      std::swap(path_portals_.back().left_m, path_portals_.back().right_m);
  }
  write_shortest_through(path.from_m, path_portals_, path.to_m, shortened_);
  const Vec2 goal = plan_.states.back();
  plan_.states.assign(1, start);
  for (const Vec2& state : shortened_)
    if (state != plan_.states.back()) plan_.states.push_back(state);
  if (goal != plan_.states.back()) plan_.states.push_back(goal);
  plan_.length = length_of(domain, plan_.states);
}

}  // namespace sidestep
