// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <queue>

#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/collision/random_world.hpp"

namespace sidestep::shortest_path_test {

/// Independent slow reference: Dijkstra on a grid. Each cell is joined with all cells up to three cells away,
/// and joins are checked by sampling. Its paths are at most 1.4 % longer than the shortest path with one grid
/// width of extra clearance.
class ReferenceGrid {
 public:
  ReferenceGrid(const PlanWorld& world, double step_m, double min_separation_m)
      : world_(world), step_m_(step_m) {
    cells_ = static_cast<int>(world.field.length_m / step_m);
    PlanWorld inflated_world = world;
    inflated_world.radius_m += min_separation_m;
    free_.resize(static_cast<std::size_t>(cells_ * cells_));
    for (int i = 0; i < cells_; ++i)
      for (int j = 0; j < cells_; ++j) free_[index(i, j)] = is_free(inflated_world, centre(i, j));
  }

  /// Length of the shortest path on the grid; infinite if there is no path.
  double length_m(const Vec2& start, const Vec2& goal) const {
    std::vector<double> length(free_.size(), std::numeric_limits<double>::infinity());
    using Item = std::tuple<double, int, int>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
    const auto [sx, sy] = cell(start);
    const auto [gx, gy] = cell(goal);
    length[index(sx, sy)] = 0;
    open.push({0, sx, sy});
    while (!open.empty()) {
      const auto [d, x, y] = open.top();
      open.pop();
      if (x == gx && y == gy) return d;
      if (d > length[index(x, y)]) continue;
      for (int dx = -3; dx <= 3; ++dx) {
        for (int dy = -3; dy <= 3; ++dy) {
          const int i = x + dx, j = y + dy;
          if (i < 0 || j < 0 || i >= cells_ || j >= cells_ || !is_open(x, y, i, j)) continue;
          const double next = d + step_m_ * std::hypot(dx, dy);
          if (next >= length[index(i, j)]) continue;
          length[index(i, j)] = next;
          open.push({next, i, j});
        }
      }
    }
    return std::numeric_limits<double>::infinity();
  }

 private:
  std::size_t index(int i, int j) const { return static_cast<std::size_t>(i * cells_ + j); }
  Vec2 centre(int i, int j) const {
    return {(i + 0.5) * step_m_ - world_.field.length_m / 2, (j + 0.5) * step_m_ - world_.field.width_m / 2};
  }
  std::pair<int, int> cell(const Vec2& p) const {
    return {static_cast<int>((p.x() + world_.field.length_m / 2) / step_m_),
            static_cast<int>((p.y() + world_.field.width_m / 2) / step_m_)};
  }
  bool is_open(int x, int y, int i, int j) const {
    const int steps = 2 * std::max(std::abs(i - x), std::abs(j - y));
    for (int k = 1; k <= steps; ++k) {
      const double part = double(k) / steps;
      if (!free_[index(static_cast<int>(std::lround(x + part * (i - x))),
                       static_cast<int>(std::lround(y + part * (j - y))))])
        return false;
    }
    return true;
  }

  const PlanWorld& world_;
  double step_m_;
  int cells_;
  std::vector<char> free_;
};

PlanWorld world_of(std::vector<Shape> obstacles) {
  PlanWorld world;
  world.obstacles = std::move(obstacles);
  return world;
}

struct Shortest {
  double exact_m, polyline_m, lazy_m;
};

Shortest plan_both(const PlanWorld& world, const Vec2& start, const Vec2& goal) {
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  const Plan<Vec2>& plan = graph.plan(start, goal);
  REQUIRE(plan.arrives());
  REQUIRE(is_valid_path(world, plan.states, 1e-9));
  LazyVisibility lazy;
  Rng rng(1);
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  const Plan<Vec2>& lazy_plan = lazy.plan(domain, start, {}, rng);
  REQUIRE(lazy_plan.arrives());
  REQUIRE(is_valid_path(world, lazy_plan.states, 1e-9));
  return {graph.shortest_m(), plan.length, lazy_plan.length};
}

/// Walls that continue other walls, start at walls or at the field's border, or overlap partly; boxes and
/// triangles with a corner on a wall.
std::vector<Shape> joined_walls(Rng& rng, std::size_t count) {
  std::vector<Segment> walls;
  std::vector<Shape> shapes;
  while (walls.size() < count) {
    const auto kind = walls.empty() ? 0 : rng.below(6);
    const Segment other = walls.empty() ? Segment{} : walls[rng.below(walls.size())];
    const Vec2 displacement =
        rng.chance(0.5) ? random_displacement(rng, 2) : Vec2(rng.chance(0.5) ? rng.uniform(-2, 2) : 0, 0);
    const Vec2 on = other.from_m + rng.uniform() * (other.to_m - other.from_m);
    if (kind == 0) walls.push_back({random_position(rng, 5), random_position(rng, 5)});
    if (kind == 1) walls.push_back({other.to_m, other.to_m + displacement});
    if (kind == 2) walls.push_back({on, on + left_of(displacement)});
    if (kind == 3) walls.push_back({{rng.chance(0.5) ? 5.0 : -5.0, on.y()}, on});
    if (kind == 4) walls.push_back({on, on + rng.uniform(0, 2) * (other.to_m - other.from_m)});
    if (kind == 5) walls.push_back({other.from_m, other.from_m + displacement});
    if (kind == 0 && (walls.back().to_m - walls.back().from_m).norm() > 3) walls.pop_back();
    if (rng.chance(0.9)) continue;
    const double width_m = rng.uniform(0, 1), length_m = rng.uniform(0, 1);
    shapes.push_back(Box{on, on + Vec2(length_m, width_m)});
    shapes.push_back(ConvexPolygon{{on, on + Vec2(-0.4, 0.3), on + Vec2(-0.4, -0.2)}});
  }
  shapes.insert(shapes.end(), walls.begin(), walls.end());
  return shapes;
}

/// Checks that the lazy and the full visibility graph agree for random queries.
void check_agreement(const PlanWorld& world, Rng& rng, std::size_t queries) {
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  LazyVisibility lazy;
  for (std::size_t i = 0; i < queries; ++i) {
    const Vec2 start = random_position(rng, 4.8), goal = random_position(rng, 4.8);
    CAPTURE(i, world.radius_m, start.transpose(), goal.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
    if (domain.start_is_blocked() || domain.goal_is_blocked()) continue;
    const Plan<Vec2>& exact = graph.plan(start, goal);
    const Plan<Vec2>& plan = lazy.plan(domain, start, {}, rng);
    REQUIRE(plan.arrives() == exact.arrives());
    REQUIRE(is_valid_path(world, plan.states, 1e-9));
    if (!exact.arrives()) continue;
    REQUIRE(is_valid_path(world, exact.states, 1e-9));
    REQUIRE(plan.length >= graph.shortest_m() * (1 - 1e-9));
    REQUIRE(plan.length <= graph.shortest_m() * 1.01);
  }
}

TEST_CASE("the shortest path around a circle consists of two tangents and an arc") {
  // start ---.._  _..--- goal, both 2 m from the centre of a circle of 0.4 m; the robot's radius is 0.1 m
  const auto [exact, polyline, lazy] = plan_both(world_of({Circle{{0, 0}, 0.4}}), {-2, 0}, {2, 0});
  const double expected = 2 * std::sqrt(4 - 0.25) + 0.5 * (std::numbers::pi - 2 * std::acos(0.25));
  CHECK(exact == Approx(expected).epsilon(1e-6));
  CHECK(polyline == Approx(expected).epsilon(1e-4));
  CHECK(lazy == Approx(expected).epsilon(3e-3));
}

TEST_CASE("the shortest path around a box turns at two corners") {
  const auto [exact, polyline, lazy] = plan_both(world_of({Box{{-1, -3}, {1, 0.5}}}), {-2, 0}, {2, 0});
  // The path consists of a tangent, an arc around a corner, an edge, another arc, and a tangent.
  const double far = std::hypot(1, 0.5), straight = std::sqrt(far * far - 0.01);
  const double turn =
      std::numbers::pi / 2 - (std::numbers::pi / 2 - std::atan2(0.5, 1)) + std::asin(0.1 / far);
  const double expected = 2 * straight + 2 + 2 * 0.1 * turn;
  CHECK(exact == Approx(expected).epsilon(1e-6));
  CHECK(polyline == Approx(expected).epsilon(1e-4));
  CHECK(lazy == Approx(expected).epsilon(3e-3));
}

TEST_CASE("the shortest path around a wall's end turns by half a circle") {
  const auto [exact, polyline, lazy] =
      plan_both(world_of({Segment{{0, -5}, {0, 3}}}), {-0.100001, 0}, {0.100001, 0});
  CHECK(exact == Approx(6 + 0.1 * std::numbers::pi).epsilon(1e-6));
  CHECK(polyline == Approx(6 + 0.1 * std::numbers::pi).epsilon(1e-4));
  CHECK(lazy == Approx(6 + 0.1 * std::numbers::pi).epsilon(3e-3));
}

TEST_CASE("lazy and full visibility graphs agree in all worlds") {
  const auto seed = GENERATE(1u, 2u, 3u);
  for (const std::string& name : world_names()) {
    const PlanWorld world = make_world(name, 12, seed);
    const ObstacleWorld obstacles(world.obstacles);
    TangentGraph graph(obstacles, world.field, world.radius_m);
    LazyVisibility lazy;
    Rng rng(1);
    for (const PlanQuery& query : world.queries) {
      CAPTURE(name, seed, query.start_m.transpose(), query.goal_m.transpose());
      const Plan<Vec2>& exact = graph.plan(query.start_m, query.goal_m);
      REQUIRE(exact.arrives());
      REQUIRE(is_valid_path(world, exact.states, 1e-9));
      REQUIRE(exact.length >= graph.shortest_m() - 1e-9);
      REQUIRE(exact.length <= graph.shortest_m() * 1.0002);
      const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
      const Plan<Vec2>& plan = lazy.plan(domain, query.start_m, {}, rng);
      REQUIRE(plan.arrives());
      REQUIRE(is_valid_path(world, plan.states, 1e-9));
      REQUIRE(plan.length >= graph.shortest_m() - 1e-9);
      REQUIRE(plan.length <= graph.shortest_m() * 1.006);
    }
  }
}

TEST_CASE("the shortest path is no longer than on a fine grid, and not much shorter") {
  const auto seed = GENERATE(4u, 5u);
  for (const std::string name : {"circles", "u"}) {
    const PlanWorld world = make_world(name, 3, seed);
    const ObstacleWorld obstacles(world.obstacles);
    TangentGraph graph(obstacles, world.field, world.radius_m);
    const ReferenceGrid upper_grid(world, 0.06, 0.06), lower_grid(world, 0.06, -0.06);
    for (const PlanQuery& query : world.queries) {
      CAPTURE(name, seed, query.start_m.transpose(), query.goal_m.transpose());
      graph.plan(query.start_m, query.goal_m);
      CHECK(graph.shortest_m() <= upper_grid.length_m(query.start_m, query.goal_m) + 0.1);
      CHECK(graph.shortest_m() >= lower_grid.length_m(query.start_m, query.goal_m) / 1.015 - 0.1);
    }
  }
}

TEST_CASE("visibility graphs report that no path exists") {
  std::vector<Shape> ring;
  for (int i = 0; i < 24; ++i)
    ring.push_back(
        Circle{2 * Vec2(std::cos(i * std::numbers::pi / 12), std::sin(i * std::numbers::pi / 12)), 0.2});
  const PlanWorld world = world_of(ring);
  const ObstacleWorld obstacles(world.obstacles);
  TangentGraph graph(obstacles, world.field, world.radius_m);
  CHECK(graph.plan({0, 0}, {4, 4}).reason == PlanReason::kUnreachable);
  CHECK(graph.plan({4, 4}, {0, 0}).reason == PlanReason::kUnreachable);
  LazyVisibility lazy;
  Rng rng(1);
  const DiscDomain domain(obstacles, world.field, world.radius_m, {4, 4}, {0, 0});
  const Plan<Vec2>& plan = lazy.plan(domain, {4, 4}, {}, rng);
  CHECK(plan.reason == PlanReason::kUnreachable);
  CHECK(is_valid_path(world, plan.states, 1e-9));
  CHECK(plan.states.back().norm() < 2.5);
}

TEST_CASE("a full visibility graph has only free tangents even if an obstacle covers the field's centre") {
  const auto seed = GENERATE(1u, 2u);
  PlanWorld world = make_world("circles", 1, seed);
  world.obstacles.push_back(Circle{{0.1, 0}, 0.5});
  world.obstacles.push_back(Circle{{0.5, 0.3}, 0.4});
  const ObstacleWorld obstacles(world.obstacles);
  const TangentGraph graph(obstacles, world.field, world.radius_m);
  const std::vector<Segment> tangents = graph.tangents();
  CAPTURE(seed);
  CHECK(tangents.size() > 100);
  for (const Segment& tangent : tangents) {
    CAPTURE(tangent.from_m.transpose(), tangent.to_m.transpose());
    REQUIRE(is_valid_path(world, {tangent.from_m, tangent.to_m}, 1e-9));
  }
}

TEST_CASE("lazy and full visibility graphs agree for random shapes and robot sizes") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 60));
  Rng rng(seed);
  PlanWorld world = world_of(random_shapes(rng, 1 + rng.below(120), 5));
  world.radius_m = rng.uniform(0.02, 0.25);
  CAPTURE(seed);
  check_agreement(world, rng, 6);
}

TEST_CASE("lazy and full visibility graphs agree for touching and overlapping walls and corners") {
  const auto seed = GENERATE(range<std::uint64_t>(1, 120));
  Rng rng(seed);
  PlanWorld world = world_of(joined_walls(rng, 2 + rng.below(30)));
  world.radius_m = rng.uniform(0.02, 0.25);
  CAPTURE(seed);
  check_agreement(world, rng, 6);
}

TEST_CASE("the shortest path around an angled wall turns once, at its corner") {
  // start |
  //       |____  goal below
  const Segment vertical{{0, 5}, {0, 0}}, horizontal{{0, 0}, {4, 0}};
  for (const auto& walls :
       {std::vector<Shape>{vertical, horizontal}, std::vector<Shape>{horizontal, vertical}}) {
    const auto [exact, polyline, lazy] = plan_both(world_of(walls), {-0.5, 4}, {3.5, -0.5});
    // The path consists of two tangents to the circle around the common corner and the arc between them.
    const double a = std::sqrt(16.25 - 0.01), b = std::sqrt(12.5 - 0.01);
    const double between = std::acos(Vec2(-0.5, 4).normalized().dot(Vec2(3.5, -0.5).normalized()));
    const double turn =
        2 * std::numbers::pi - between - std::acos(0.1 / std::sqrt(16.25)) - std::acos(0.1 / std::sqrt(12.5));
    const double expected = a + b + 0.1 * turn;
    CHECK(exact == Approx(expected).epsilon(1e-4));
    CHECK(lazy == Approx(expected).epsilon(3e-3));
  }
}

}  // namespace sidestep::shortest_path_test
