// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/route_planner.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <span>

#include "common/config/planner_names.hpp"
#include "common/map/floor_map.hpp"
#include "common/map/floor_plan.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::route_planner_test {

constexpr double kRadius_m = 0.09, kMargin_m = 0.02;
const Field kField{4, 4};

const NamedPlanner& shortest() {
  static const NamedPlanner planner = make_driving_planner("lazy-visibility");
  return planner;
}
Rng& random() {
  static Rng rng(1);
  return rng;
}

struct World {
  ObstacleWorld world;
};
struct PlannerInWorld : World, RoutePlanner {
  PlannerInWorld(const NamedPlanner& named, const std::vector<Shape>& obstacles, const Field& field,
                 double radius_m, double margin_m, std::span<const double> extra_clearances_m,
                 const Vec2& goal_m)
      : World{ObstacleWorld(obstacles)},
        RoutePlanner(named, world, field, radius_m, margin_m, extra_clearances_m) {
    begin(goal_m);
  }
  PlannerInWorld(const NamedPlanner& named, const std::vector<Shape>& obstacles, const Field& field,
                 double radius_m, double margin_m, double extra_clearance_m, const Vec2& goal_m)
      : PlannerInWorld(named, obstacles, field, radius_m, margin_m, {&extra_clearance_m, 1}, goal_m) {}
};

std::vector<Shape> shapes_of(const std::vector<Circle>& circles) { return {circles.begin(), circles.end()}; }

/// Independent slow reference: Dijkstra on an 8-connected grid of 2 cm. Its paths are at most 8.3 % longer
/// than the shortest ones.
double grid_length(const std::vector<Circle>& obstacles, const Vec2& start, const Vec2& goal,
                   double inflation) {
  const int n = 200;
  const double step = 4.0 / n;
  const auto cell = [&](const Vec2& p) {
    return std::pair{static_cast<int>((p.x() + 2) / step), static_cast<int>((p.y() + 2) / step)};
  };
  std::vector<double> length(n * n, std::numeric_limits<double>::infinity());
  const auto at = [&](int x, int y) -> double& { return length[static_cast<std::size_t>(x * n + y)]; };
  using Item = std::tuple<double, int, int>;
  std::priority_queue<Item, std::vector<Item>, std::greater<>> open;
  const auto [sx, sy] = cell(start);
  at(sx, sy) = 0;
  open.push({0, sx, sy});
  while (!open.empty()) {
    const auto [d, x, y] = open.top();
    open.pop();
    if (d > at(x, y)) continue;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        const int i = x + dx, j = y + dy;
        if (i < 0 || j < 0 || i >= n || j >= n) continue;
        const Vec2 p(-2 + (i + 0.5) * step, -2 + (j + 0.5) * step);
        bool free = kField.contains(p, kRadius_m);
        for (const Circle& o : obstacles) free = free && (p - o.centre_m).norm() > o.radius_m + inflation;
        const double next = d + step * std::hypot(dx, dy);
        if (!free || next >= at(i, j)) continue;
        at(i, j) = next;
        open.push({next, i, j});
      }
    }
  }
  const auto [gx, gy] = cell(goal);
  return at(gx, gy);
}

TEST_CASE("without obstacles the route is straight") {
  PlannerInWorld planner(shortest(), {}, kField, kRadius_m, kMargin_m, 0, {1, 1});
  const auto route = planner.route_from({-1, -1}, random());
  REQUIRE(route);
  CHECK(route->waypoint_m == Vec2(1, 1));
  CHECK(route->length_m == Approx(2 * std::sqrt(2.0)));
}

TEST_CASE("a route keeps its margin from obstacles and is no longer than on a fine grid") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u);
  CAPTURE(seed);
  Rng rng(seed);
  std::vector<Circle> obstacles;
  for (int i = 0; i < 12; ++i) {
    const double y = rng.uniform(-1.2, 1.2), x = rng.uniform(-1.2, 1.2);
    obstacles.push_back({{x, y}, rng.uniform(0.05, 0.25)});
  }
  const Vec2 start(-1.8, -1.8), goal(1.8, 1.8);
  PlannerInWorld planner(shortest(), shapes_of(obstacles), kField, kRadius_m, kMargin_m, 0, goal);
  const double reference = grid_length(obstacles, start, goal, kRadius_m + kMargin_m + 0.02);
  REQUIRE(reference < 20);
  Vec2 here = start;
  double travelled = 0;
  auto route = planner.route_from(here, random());
  REQUIRE(route);
  CHECK(route->length_m <= reference);
  const double promised = route->length_m;
  for (int leg = 0; leg < 50 && (here - goal).norm() > 1e-9; ++leg) {
    route = planner.route_from(here, random());
    REQUIRE(route);
    for (int k = 0; k <= 100; ++k) {
      const Vec2 p = here + k / 100.0 * (route->waypoint_m - here);
      for (const Circle& o : obstacles)
        REQUIRE((p - o.centre_m).norm() >= o.radius_m + kRadius_m + kMargin_m - 1e-9);
    }
    travelled += (route->waypoint_m - here).norm();
    here = route->waypoint_m;
  }
  CHECK(travelled == Approx(promised));
}

/// The smallest distance from the goal among the positions on a grid of 2 cm that are connected to the start.
double nearest_on_grid(const std::vector<Shape>& obstacles, const Vec2& start, const Vec2& goal,
                       double clearance) {
  const auto is_free = [&](const Vec2& p) {
    return kField.contains(p, kRadius_m) && std::ranges::all_of(obstacles, [&](const Shape& shape) {
             return signed_distance(p, shape) > clearance;
           });
  };
  constexpr int kCells = 200;
  const auto position = [](int x, int y) { return Vec2(-2 + 0.02 * x, -2 + 0.02 * y); };
  std::vector<bool> seen(kCells * kCells);
  std::vector<std::pair<int, int>> open{
      {static_cast<int>((start.x() + 2) / 0.02), static_cast<int>((start.y() + 2) / 0.02)}};
  double nearest = std::numeric_limits<double>::infinity();
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (x < 0 || y < 0 || x >= kCells || y >= kCells) continue;
    const auto cell = static_cast<std::size_t>(x * kCells + y);
    if (seen[cell] || !is_free(position(x, y))) continue;
    seen[cell] = true;
    nearest = std::min(nearest, (position(x, y) - goal).norm());
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      open.emplace_back(x + dx, y + dy);
  }
  return nearest;
}

TEST_CASE("the route to an enclosed or covered goal ends as near to the goal as the robot can get") {
  int enclosed = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Rng rng(seed);
    // A ring of obstacles, with or without a gap, around a goal that may be covered, among other obstacles.
    std::vector<Shape> obstacles;
    const double ring_y = rng.uniform(-0.8, 0.8), ring_x = rng.uniform(-0.8, 0.8);
    const Vec2 middle(ring_x, ring_y), start(-1.8, -1.8);
    for (int i = rng.below(4) == 0 ? 2 : 0; i < 12; ++i)
      obstacles.emplace_back(Circle{middle + rotated({0.5, 0}, i * 0.5236), 0.1});
    if (rng.below(2) == 0)
      obstacles.emplace_back(Circle{middle + rotated({0.1, 0}, rng.uniform(0, 6)), 0.12});
    for (int i = 0; i < 4; ++i) {
      const double y = rng.uniform(-1.5, 1.5), x = rng.uniform(-1.3, 1.5);
      obstacles.emplace_back(Box{{x, y}, {x + rng.uniform(0.1, 0.4), y + rng.uniform(0.1, 0.4)}});
    }
    CAPTURE(seed, middle.transpose());
    const double clearance = kRadius_m + kMargin_m;
    PlannerInWorld planner(shortest(), obstacles, kField, kRadius_m, kMargin_m, 0, middle);
    const double reference = nearest_on_grid(obstacles, start, middle, clearance + 0.005);
    REQUIRE(reference < 4);
    const auto route = planner.route_from(start, random());
    REQUIRE(route);
    CHECK(route->reaches_goal == (route->end_m == middle));
    CHECK((route->end_m - middle).norm() <= reference + 0.03);
    if (route->reaches_goal) continue;
    ++(planner.obstacle_on_goal() ? covered : enclosed);
    // The whole route is free and is kept.
    Vec2 here = start;
    for (int leg = 0; leg < 50 && (here - route->end_m).norm() > 1e-9; ++leg) {
      const auto next = planner.route_from(here, random());
      REQUIRE(next);
      CHECK(next->end_m == route->end_m);
      for (int k = 0; k <= 100; ++k) {
        for (const Shape& shape : obstacles)
          REQUIRE(signed_distance(here + k / 100.0 * (next->waypoint_m - here), shape) >= clearance - 1e-9);
      }
      here = next->waypoint_m;
    }
    CHECK((here - route->end_m).norm() < 1e-9);
  }
  CHECK(enclosed > 5);
  CHECK(covered > 5);
}

TEST_CASE("a robot reaches a goal that is nearer to an obstacle than the preferred clearance") {
  const Vec2 goal(0, 0.2 + kRadius_m + kMargin_m + 0.01);
  PlannerInWorld planner(shortest(), {Circle{{0, 0}, 0.2}}, kField, kRadius_m, kMargin_m, 0.03, goal);
  const auto route = planner.route_from({0, -1}, random());
  REQUIRE(route);
  CHECK(route->reaches_goal);
  CHECK(route->end_m == goal);
  CHECK_FALSE(planner.obstacle_on_goal());
}

TEST_CASE("every planner leads through a passage that is hardly wider than the robot") {
  const double half_m = kRadius_m + kMargin_m + 0.003;
  const std::vector<Shape> walls{Box{{-0.5, -2}, {0.5, -half_m}}, Box{{-0.5, half_m}, {0.5, 2}}};
  for (const std::string_view name : kDrivingPlanners) {
    CAPTURE(name);
    const NamedPlanner named = make_driving_planner(std::string(name));
    PlannerInWorld planner(named, walls, kField, kRadius_m, kMargin_m, 0.03, {1.5, 1});
    Vec2 here(-1.5, 1);
    Rng rng(1);
    for (int i = 0; i < 1000 && here != Vec2(1.5, 1); ++i) {
      const auto route = planner.route_from(here, rng);
      REQUIRE(route);
      REQUIRE(route->reaches_goal);
      const Vec2 ahead = route->waypoint_m - here;
      here = ahead.norm() <= 0.05 ? route->waypoint_m : Vec2(here + 0.05 * ahead.normalized());
    }
    CHECK(here == Vec2(1.5, 1));
  }
}

/// Drives a route to its end. Returns the length, which is infinite if the goal is not reached, and the
/// smallest clearance at positions more than 0.7 m from start and goal.
std::pair<double, double> length_and_clearance(const NamedPlanner& named, const std::vector<Shape>& obstacles,
                                               const Vec2& start, const Vec2& goal) {
  const ObstacleWorld world(obstacles);
  PlannerInWorld planner(named, obstacles, kField, kRadius_m, kMargin_m, 0.03, goal);
  Rng rng(1);
  Vec2 here = start;
  double length = 0, clearance = 1;
  for (int i = 0; i < 2000 && here != goal; ++i) {
    const auto route = planner.route_from(here, rng);
    if (!route || !route->reaches_goal) break;
    const Vec2 ahead = route->waypoint_m - here;
    const Vec2 next = ahead.norm() <= 0.02 ? route->waypoint_m : Vec2(here + 0.02 * ahead.normalized());
    length += (next - here).norm();
    here = next;
    if ((here - start).norm() > 0.7 && (here - goal).norm() > 0.7)
      clearance = std::min(clearance, world.nearest(here).distance_m - kRadius_m);
  }
  return {here == goal ? length : std::numeric_limits<double>::infinity(), clearance};
}

TEST_CASE("with a clearance cost, robots drive through the middle of gaps on slightly longer routes") {
  const NamedPlanner plain = make_driving_planner("estar"), clear = make_driving_planner("estar-clearance");
  int scenes = 0, clearer = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    // Two walls, each with a gap that is 0.5 to 0.8 m wide.
    std::vector<Shape> walls;
    for (const double x : {-0.5, 0.5}) {
      const double middle = rng.uniform(-1.2, 1.2), half = rng.uniform(0.25, 0.4);
      walls.emplace_back(Box{{x - 0.05, -2}, {x + 0.05, middle - half}});
      walls.emplace_back(Box{{x - 0.05, middle + half}, {x + 0.05, 2}});
    }
    const Vec2 start(-1.6, rng.uniform(-1.5, 1.5)), goal(1.6, rng.uniform(-1.5, 1.5));
    const auto [plain_m, plain_clearance_m] = length_and_clearance(plain, walls, start, goal);
    const auto [clear_m, clear_clearance_m] = length_and_clearance(clear, walls, start, goal);
    REQUIRE(clear_m < 1.3 * plain_m);
    CHECK(clear_clearance_m > 0.1);
    ++scenes;
    clearer += clear_clearance_m > plain_clearance_m + 0.03 ? 1 : 0;
  }
  CHECK(clearer > scenes / 2);
}

TEST_CASE("a robot too near an obstacle may leave it but not drive through it") {
  PlannerInWorld planner(shortest(), {Circle{{0, 0}, 0.2}}, kField, kRadius_m, kMargin_m, 0, {1, 0});
  const Vec2 near(-0.25, 0);
  const auto route = planner.route_from(near, random());
  REQUIRE(route);
  CHECK(route->waypoint_m != Vec2(1, 0));
  CHECK((route->waypoint_m - near).dot(near) >= 0);
}

TEST_CASE("a robot that drifts sideways keeps one of two equally long routes") {
  const Circle middle{{0, 0}, 0.3};
  PlannerInWorld planner(shortest(), {middle}, kField, kRadius_m, kMargin_m, 0, {1.5, 0});
  Vec2 here(-1.5, 1e-3);
  const auto first = planner.route_from(here, random());
  REQUIRE(first);
  const double side = first->waypoint_m.y();
  REQUIRE(side != 0);
  double length = first->length_m;
  while ((here - Vec2(1.5, 0)).norm() > 0.05) {
    const auto route = planner.route_from(here, random());
    REQUIRE(route);
    CHECK(route->waypoint_m.y() * side >= 0);
    CHECK(route->length_m < length + 0.05);
    length = route->length_m;
    const Vec2 ahead = (route->waypoint_m - here).normalized();
    // Initially the robot drifts back and forth across the line on which both routes are equally long.
    const double deviation = here.x() < -0.8 ? -0.004 * std::copysign(1.0, here.y()) : 0;
    here += 0.02 * ahead + Vec2(0, deviation);
  }
}

TEST_CASE("a robot that was pushed off its route replans") {
  PlannerInWorld planner(shortest(), {Circle{{0, 0}, 0.3}}, kField, kRadius_m, kMargin_m, 0, {1.5, 0});
  const auto above = planner.route_from({-0.5, 0.3}, random());
  REQUIRE(above);
  CHECK(above->waypoint_m.y() > 0);
  const auto below = planner.route_from({-0.5, -0.3}, random());
  REQUIRE(below);
  CHECK(below->waypoint_m.y() < 0);
}

TEST_CASE("routes keep the extra clearance, but also pass through gaps that are too narrow for it") {
  const double extra_clearance = 0.05;
  const std::vector<Circle> pair{{{0, 0.4}, 0.2}, {{0, -0.4}, 0.2}};
  PlannerInWorld generous(shortest(), shapes_of(pair), kField, kRadius_m, kMargin_m, extra_clearance,
                          {1.5, 0.3});
  const auto wide_route = generous.route_from({-1.5, 0.3}, random());
  REQUIRE(wide_route);
  CHECK((wide_route->waypoint_m - pair[0].centre_m).norm() >= 0.2 + kRadius_m + kMargin_m + extra_clearance);

  // The gap in the wall of discs is too narrow for the extra clearance.
  std::vector<Circle> wall;
  for (int i = -4; i <= 4; ++i) {
    if (i != 0) wall.push_back({{0, 0.45 * i + std::copysign(0.08, i)}, 0.3});
  }
  const double gap = 2 * (0.45 + 0.08 - 0.3);
  REQUIRE(gap / 2 > kRadius_m + kMargin_m);
  REQUIRE(gap / 2 < kRadius_m + kMargin_m + 0.15);
  PlannerInWorld wall_planner(shortest(), shapes_of(wall), kField, kRadius_m, kMargin_m, 0.15, {1.5, 0.2});
  const auto narrow_route = wall_planner.route_from({-1.5, 0.2}, random());
  REQUIRE(narrow_route);
  for (const Circle& disc : wall)
    CHECK((narrow_route->waypoint_m - disc.centre_m).norm() >= disc.radius_m + kRadius_m + kMargin_m - 1e-9);
}

TEST_CASE("a robot that starts in overlapping obstacles leaves them towards the nearest free position") {
  // On the line between the centres, every way out of one circle first leads deeper into the other.
  PlannerInWorld planner(shortest(),
                         {Circle{{-0.25, 0}, 0.4}, Circle{{0.25, 0}, 0.4}, Circle{{0, -0.2}, 0.3}}, kField,
                         kRadius_m, kMargin_m, 0, {0, 0});
  const auto route = planner.route_from({0, 0}, random());
  REQUIRE(route);
  CHECK_FALSE(route->reaches_goal);
  CHECK(std::abs(route->end_m.x()) < 0.01);
  CHECK(route->end_m.y() == Approx(std::sqrt(0.51 * 0.51 - 0.25 * 0.25)).margin(0.01));
}

TEST_CASE("with every planner, a robot that follows its route gets around obstacles to its goal") {
  const auto name = std::string(GENERATE(from_range(kDrivingPlanners.begin(), kDrivingPlanners.end())));
  CAPTURE(name);
  const NamedPlanner named = make_driving_planner(name);
  Rng rng(3);
  for (int scene = 0; scene < 5; ++scene) {
    std::vector<Shape> obstacles;
    for (int i = 0; i < 6; ++i)
      obstacles.emplace_back(Circle{{rng.uniform(-0.8, 0.8), rng.uniform(-1.5, 1.5)}, rng.uniform(0.1, 0.3)});
    obstacles.emplace_back(Box{{-0.1, -1}, {0.1, 1}});
    const Vec2 goal(1.6, rng.uniform(-1.5, 1.5));
    const ObstacleWorld world(obstacles);
    PlannerInWorld planner(named, obstacles, kField, kRadius_m, kMargin_m, 0.02, goal);
    Vec2 here(-1.6, rng.uniform(-1.5, 1.5));
    int steps = 0;
    while ((here - goal).norm() > 0.01 && steps < 500) {
      const auto route = planner.route_from(here, rng);
      REQUIRE(route);
      REQUIRE(route->reaches_goal);
      const Vec2 next = here + std::min(0.05, (route->waypoint_m - here).norm()) *
                                   (route->waypoint_m - here).stableNormalized();
      REQUIRE_FALSE(world.touches(here, next, kRadius_m + kMargin_m - 1e-9));
      here = next;
      ++steps;
    }
    CAPTURE(scene, steps);
    CHECK((here - goal).norm() <= 0.01);
    CHECK(steps < 200);
  }
}

/// Follows a route in small steps to its end. Returns the smallest distance from obstacles along the way, and
/// the smallest distance while the robot is farther than `tight_m` from the goal.
std::pair<double, double> drive(PlannerInWorld& planner, Vec2 at, const Vec2& goal, double tight_m) {
  double nearest_m = 1e9, nearest_before_m = 1e9;
  for (int step = 0; step < 2000 && (at - goal).norm() > 1e-6; ++step) {
    const auto route = planner.route_from(at, random());
    REQUIRE(route);
    CHECK(route->reaches_goal);
    const Vec2 way = route->waypoint_m - at;
    at += std::min(0.01, way.norm()) * way.stableNormalized();
    const double distance_m = planner.world.nearest(at).distance_m;
    nearest_m = std::min(nearest_m, distance_m);
    if ((at - goal).norm() > tight_m) nearest_before_m = std::min(nearest_before_m, distance_m);
  }
  CHECK((at - goal).norm() <= 1e-6);
  return {nearest_m, nearest_before_m};
}

//   |        the gap is 2 w wide: routes keep the largest of the
//   o->  *   clearances that fits
//   |
TEST_CASE("routes keep the largest extra clearance that fits through a gap") {
  const std::vector<double> extra_m{0.4, 0.25, 0.1};
  for (const auto& [half_gap_m, expected_m] :
       {std::pair{0.6, 0.4}, std::pair{0.45, 0.25}, std::pair{0.3, 0.1}, std::pair{0.15, 0.0}}) {
    CAPTURE(half_gap_m);
    PlannerInWorld planner(shortest(),
                           {Box{{-0.05, -2}, {0.05, -half_gap_m}}, Box{{-0.05, half_gap_m}, {0.05, 2}}},
                           kField, kRadius_m, kMargin_m, extra_m, {1.2, 1});
    const double nearest_m = drive(planner, {-1.2, -1}, {1.2, 1}, 0).first;
    CHECK(nearest_m >= kRadius_m + kMargin_m + expected_m - 1e-6);
    CHECK(nearest_m < kRadius_m + kMargin_m + expected_m + 0.02);
  }
}

//   +-----
//   | *      the goal is in a corner: only the last leg comes near
//   |        the walls
//        o
TEST_CASE("a goal near obstacles is reached from the nearest place with full clearance") {
  const std::vector<double> extra_m{0.4, 0.03};
  const Vec2 goal(-1.2, 1.3);
  PlannerInWorld planner(shortest(), {Box{{-1.5, -0.5}, {-1.4, 1.6}}, Box{{-1.5, 1.5}, {1.5, 1.6}}}, kField,
                         kRadius_m, kMargin_m, extra_m, goal);
  const auto [nearest_m, before_m] = drive(planner, {-1.7, -1.2}, goal, 0.6);
  CHECK(nearest_m >= kRadius_m + kMargin_m - 1e-6);
  CHECK(before_m >= kRadius_m + kMargin_m + 0.4 - 1e-6);
}

/// A corridor that is 60 m long. Walls with gaps on alternating sides make the route long.
std::vector<Shape> slalom() {
  std::vector<Shape> walls;
  for (int i = 0; i < 80; ++i) {
    const double x = -28 + 0.7 * i;
    walls.emplace_back(i % 2 == 0 ? Box{{x, -2}, {x + 0.1, 1.4}} : Box{{x, -1.4}, {x + 0.1, 2}});
  }
  return walls;
}

TEST_CASE("a search for a long route continues over several cycles and finds the shortest route") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  const Field field{80, 80};
  MapGrid grid;
  grid.columns = grid.rows = 1600;
  grid.origin_m = {-40, -40};
  const FloorMap map(make_floor_plan(seed, grid));
  const auto free_near = [&](Vec2 p) {
    while (map.cells().distance_m(p, 1) < 0.3) p -= 0.01 * p.normalized();
    return p;
  };
  const Vec2 start = free_near({-39, -39}), goal = free_near({39, 39});
  const std::vector<Box> boxes = map.boxes_on(field);
  PlannerInWorld planner(shortest(), {boxes.begin(), boxes.end()}, field, kRadius_m, kMargin_m, 0.02, goal);
  std::optional<Route> route;
  int cycles = 0;
  do {
    route = planner.route_from(start, random());
    ++cycles;
    CHECK(route.has_value() != planner.is_searching());
  } while (!route && cycles < 20);
  REQUIRE(route);
  CHECK(cycles > 1);
  CHECK(route->reaches_goal);
  CHECK(planner.effort() == Approx(1 << (cycles - 1)));
  const DiscDomain domain(planner.world, {80.04, 80.04}, kRadius_m + kMargin_m + 0.02, start, goal,
                          shortest().domain_settings(field, kRadius_m));
  Budget unlimited;
  unlimited.samples = unlimited.nodes = 100'000'000;
  CHECK(route->length_m == Approx(shortest().plan(domain, start, unlimited, random()).length).margin(0.01));
}

TEST_CASE("a route leads around nearby changes and rejoins the unchanged part far away") {
  const Vec2 start(-29.5, 0), goal(29.5, 0);
  PlannerInWorld planner(shortest(), slalom(), {60, 4}, kRadius_m, kMargin_m, 0.02, goal);
  std::optional<Route> route;
  for (int i = 0; i < 20 && !route; ++i) route = planner.route_from(start, random());
  REQUIRE(route);
  const std::vector<Vec2> before(planner.remaining_waypoints_m().begin(),
                                 planner.remaining_waypoints_m().end());
  const double effort = planner.effort();
  // The circle is on the first leg, slightly off its line.
  planner.world.add(Circle{(start + before.front()) / 2 + Vec2(0, 0.02), 0.1});
  planner.begin(goal);
  const std::optional<Route> around = planner.route_from(start, random());
  REQUIRE(around);
  CHECK(around->reaches_goal);
  CHECK(around->length_m > route->length_m);
  CHECK(around->length_m < route->length_m + 0.5);
  CHECK(planner.effort() == effort);
  const std::span<const Vec2> after = planner.remaining_waypoints_m();
  CHECK(after.front() != before.front());
  CHECK(std::equal(before.end() - 40, before.end(), after.end() - 40));
  // If the far part is blocked, the whole route is replanned.
  planner.world.add(Box{{10, -2}, {10.05, 2}});
  planner.begin(goal);
  std::optional<Route> blocked;
  for (int i = 0; i < 20 && !blocked; ++i) blocked = planner.route_from(start, random());
  REQUIRE(blocked);
  CHECK_FALSE(blocked->reaches_goal);
}

}  // namespace sidestep::route_planner_test
