// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/roadmaps/prm.hpp"

#include <numbers>
#include <set>

#include "agents/planning/domain/disc_domain.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/catch.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep::prm_test {

using Roadmaps = Prm<DiscDomain>;

/// Length of the shortest path between the roadmap's last two nodes, by Bellman-Ford over the edges that are
/// free in this world.
double shortest_on(const Roadmap<DiscDomain>& map, const DiscDomain& domain) {
  std::vector<double> length(map.size(), std::numeric_limits<double>::infinity());
  length[map.size() - 2] = 0;
  for (std::size_t round = 0; round < map.size(); ++round) {
    bool changed = false;
    for (const auto& edge : map.edges()) {
      if (!domain.check(map[edge.a], map[edge.b])) continue;
      for (const auto& [from, to] : {std::pair{edge.a, edge.b}, std::pair{edge.b, edge.a}}) {
        if (length[from] + edge.length >= length[to]) continue;
        length[to] = length[from] + edge.length;
        changed = true;
      }
    }
    if (!changed) break;
  }
  return length.back();
}

TEST_CASE("roadmaps find valid paths in all worlds, and the same seed gives the same paths") {
  const auto seed = GENERATE(1u, 2u);
  const PrmSettings radial{.connection = {.method = Connection::kRadial, .neighbours = 8}};
  const PrmSettings within{.connection = {.method = Connection::kRadius}};
  for (const PrmSettings& settings : {PrmSettings{}, one_shot_prm(), dynamic_prm(), radial, within}) {
    for (const std::string& name : world_names()) {
      const PlanWorld world = make_world(name, 12, seed);
      const ObstacleWorld obstacles(world.obstacles);
      Roadmaps planner(settings), again(settings);
      Rng rng(seed), rng_again(seed);
      int solved = 0;
      for (const PlanQuery& query : world.queries) {
        CAPTURE(name, seed, query.start_m.transpose(), query.goal_m.transpose());
        const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
        const Plan<Vec2>& plan = planner.plan(domain, query.start_m, {.nodes = 2000}, rng);
        REQUIRE(plan.states == again.plan(domain, query.start_m, {.nodes = 2000}, rng_again).states);
        REQUIRE(is_valid_path(world, plan.states, 1e-9));
        REQUIRE(plan.length == Approx(length_of(domain, plan.states)));
        REQUIRE(plan.states.front() == query.start_m);
        if (!plan.arrives()) continue;
        REQUIRE(plan.states.back() == query.goal_m);
        ++solved;
      }
      CAPTURE(name, seed);
      CHECK(solved >= 10);
    }
  }
}

TEST_CASE("a query returns the roadmap's shortest path, even after obstacles have moved") {
  const auto seed = GENERATE(1u, 2u, 3u);
  const PlanWorld world = make_world("circles", 30, seed);
  ObstacleWorld obstacles(world.obstacles);
  Rng rng(seed);
  Roadmaps planner(dynamic_prm());
  PlanWorld now = world;
  int compared = 0;
  for (const PlanQuery& query : world.queries) {
    for (std::uint32_t i = 0; i < now.obstacles.size(); ++i) {
      const double y = rng.uniform(-0.2, 0.2), x = rng.uniform(-0.2, 0.2);
      const Vec2 by(x, y);
      now.obstacles[i] = moved(now.obstacles[i], by);
      obstacles.move(ObstacleId{i}, by);
    }
    CAPTURE(seed, query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    if (domain.start_is_blocked() || domain.goal_is_blocked()) continue;
    const Plan<Vec2>& plan = planner.plan(domain, query.start_m, {.nodes = 2000}, rng);
    REQUIRE(is_valid_path(now, plan.states, 1e-9));
    if (!plan.arrives() || plan.states.size() == 2) continue;
    REQUIRE(plan.length == Approx(shortest_on(planner.roadmap(), domain)));
    ++compared;
  }
  CHECK(compared >= 10);
}

/// A wall with a gap and a passage at its end. A box closes the gap:
///
///     |    .    |
///     |    #    |
///     |    o    |
///     |    #    |
///     | s  #  g |
///     |    #    |
struct GapWorld {
  static constexpr double kHalfGap_m = 0.6;
  GapWorld() {
    world.obstacles = {Box{{-0.1, kHalfGap_m}, {0.1, 4}}, Box{{-0.1, -5}, {0.1, -kHalfGap_m}}};
    obstacles = ObstacleWorld(world.obstacles);
    closing = obstacles.add(Box{{-0.1, -kHalfGap_m}, {0.1, kHalfGap_m}});
  }
  DiscDomain domain() const { return {obstacles, world.field, world.radius_m, start_m, goal_m}; }
  void open() { obstacles.move(closing, {0, 20}); }

  PlanWorld world;
  ObstacleWorld obstacles;
  ObstacleId closing{};
  Vec2 start_m{-3, -3}, goal_m{3, -3};
};

bool goes_through_gap(const std::vector<Vec2>& path) {
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec2 &from = path[i - 1], &to = path[i];
    if (from.x() > 0 || to.x() <= 0) continue;
    const double y = from.y() + (to.y() - from.y()) * from.x() / (from.x() - to.x());
    return std::abs(y) < GapWorld::kHalfGap_m;
  }
  return false;
}

/// Length of the shortest path between the last two nodes of a new roadmap with the same nodes.
double shortest_on_new(const Roadmap<DiscDomain>& old, const DiscDomain& domain) {
  Roadmap<DiscDomain> fresh;
  for (std::uint32_t node = 0; node < old.size(); ++node)
    fresh.add(domain, old[node], {Connection::kRadial, 8}, 1);
  return shortest_on(fresh, domain);
}

TEST_CASE("a dynamic roadmap uses a gap that was closed when the roadmap was built") {
  Distribution same_nodes, new_nodes;  // length relative to that on a new roadmap
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    GapWorld gap;
    Rng rng(seed);
    Roadmaps planner(dynamic_prm());
    const Plan<Vec2> closed = planner.plan(gap.domain(), gap.start_m, {}, rng);
    REQUIRE(closed.arrives());
    REQUIRE_FALSE(goes_through_gap(closed.states));
    gap.open();
    // With this budget, no node is added.
    const Budget budget{.nodes = planner.roadmap().size()};
    const Plan<Vec2> opened = planner.plan(gap.domain(), gap.start_m, budget, rng);
    REQUIRE(opened.arrives());
    REQUIRE(is_valid_path(gap.world, opened.states, 1e-9));
    REQUIRE(goes_through_gap(opened.states));
    REQUIRE(opened.length < 0.7 * closed.length);
    same_nodes.add(opened.length / shortest_on_new(planner.roadmap(), gap.domain()));
    Rng new_rng(seed);
    Roadmaps new_planner(dynamic_prm());
    const Plan<Vec2> fresh = new_planner.plan(gap.domain(), gap.start_m, {}, new_rng);
    REQUIRE(fresh.arrives());
    new_nodes.add(opened.length / fresh.length);
  }
  CAPTURE(same_nodes.median(), same_nodes.quantile(1), new_nodes.median(), new_nodes.quantile(1));
  CHECK(same_nodes.median() < 1.01);
  CHECK(same_nodes.quantile(1) < 1.1);
  // A new roadmap may have nodes in the gap.
  CHECK(new_nodes.median() < 1.1);
  CHECK(new_nodes.quantile(1) < 1.25);
}

TEST_CASE("an old roadmap that keeps all blocked motions is as good as a new one once obstacles leave") {
  const auto seed = GENERATE(1u, 2u, 3u);
  PlanWorld world = make_world("circles", 15, seed);
  ObstacleWorld obstacles(world.obstacles);
  const PrmSettings settings{
      .connection = {.method = Connection::kRadial, .neighbours = 8, .blocked_per_sector = 100},
      .is_dynamic = true};
  Rng rng(seed);
  Roadmaps planner(settings);
  planner.build({obstacles, world.field, world.radius_m, {0, 0}, {0, 0}}, {}, rng);
  const std::size_t nodes = planner.roadmap().size(), edges = planner.roadmap().free_edge_count();
  for (std::uint32_t i = 0; i < obstacles.size(); i += 2) obstacles.move(ObstacleId{i}, {30, 0});
  int compared = 0;
  for (const PlanQuery& query : world.queries) {
    CAPTURE(seed, query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    const Plan<Vec2>& plan = planner.plan(domain, query.start_m, {.nodes = nodes}, rng);
    if (plan.states.size() == 2) continue;
    const double shortest_m = shortest_on_new(planner.roadmap(), domain);
    if (shortest_m < std::numeric_limits<double>::infinity()) REQUIRE(plan.arrives());
    if (plan.arrives()) REQUIRE(plan.length <= shortest_m * (1 + 1e-9));
    ++compared;
  }
  CHECK(compared >= 8);
  // The roadmap keeps motions that are blocked in this world as edges, but not as free edges.
  CHECK(planner.roadmap().edges().size() > edges);
}

TEST_CASE("a roadmap of an unchanging world does not use blocked motions") {
  const auto seed = GENERATE(1u, 2u);
  const PlanWorld world = make_world("circles", 15, seed);
  const ObstacleWorld obstacles(world.obstacles);
  ConnectionSettings keeping{.method = Connection::kRadial, .neighbours = 8, .blocked_per_sector = 3};
  const ConnectionSettings plain{.method = Connection::kRadial, .neighbours = 8};
  Roadmaps with(PrmSettings{.connection = keeping}), without(PrmSettings{.connection = plain});
  Rng with_rng(seed), without_rng(seed);
  for (const PlanQuery& query : world.queries) {
    CAPTURE(seed, query.start_m.transpose(), query.goal_m.transpose());
    const DiscDomain domain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m);
    REQUIRE(with.plan(domain, query.start_m, {.nodes = 2000}, with_rng).states ==
            without.plan(domain, query.start_m, {.nodes = 2000}, without_rng).states);
  }
  CHECK(with.roadmap().free_edge_count() == without.roadmap().edges().size());
  CHECK(with.roadmap().edges().size() > without.roadmap().edges().size());
}

TEST_CASE("radial connection joins a node with one neighbour in each sector") {
  const ObstacleWorld nothing;
  const DiscDomain domain(nothing, {10, 10}, 0.1, {0, 0}, {1, 1});
  Rng rng(1);
  Roadmap<DiscDomain> map;
  for (int i = 0; i < 200; ++i) map.add(domain, domain.sample(rng), {.neighbours = 3}, 1);
  const auto node = map.add(domain, {0.01, 0.02}, {Connection::kRadial, 8}, 1);
  CHECK(map.edges_of(node).size() == 8);
  std::set<int> sectors;
  for (const auto edge : map.edges_of(node)) {
    const Vec2 to = map[map.edges()[edge].other(node)] - map[node];
    sectors.insert(static_cast<int>((std::atan2(to.y(), to.x()) / (2 * std::numbers::pi) + 0.5) * 8));
  }
  CHECK(sectors.size() == 8);
}

TEST_CASE("connection within a radius joins a node with all visible nodes within that radius") {
  const auto seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  const PlanWorld world = make_world("circles", 1, seed);
  const ObstacleWorld obstacles(world.obstacles);
  const DiscDomain domain(obstacles, world.field, world.radius_m, {0, 0}, {1, 1});
  Rng rng(seed);
  Roadmap<DiscDomain> map;
  std::size_t joined = 0;
  for (int i = 0; i < 200; ++i) {
    const auto node = map.add(domain, domain.sample(rng), {.method = Connection::kRadius, .radius = 1.2}, 1);
    std::set<std::uint32_t> seen, found;
    for (std::uint32_t other = 0; other < node; ++other)
      if ((map[node] - map[other]).norm() <= 1.2 && domain.check(map[node], map[other])) seen.insert(other);
    for (const auto edge : map.edges_of(node)) found.insert(map.edges()[edge].other(node));
    REQUIRE(found == seen);
    joined += found.size();
  }
  CHECK(joined > 100);
}

TEST_CASE("a roadmap built in advance equals the roadmap that the first query would build") {
  const PlanWorld world = make_world("circles", 1, 3);
  const ObstacleWorld obstacles(world.obstacles);
  const auto& [start, goal] = world.queries[0];
  const DiscDomain domain(obstacles, world.field, world.radius_m, start, goal);
  REQUIRE_FALSE(domain.check(start, goal));
  Roadmaps built, queried;
  Rng built_rng(3), queried_rng(3);
  built.build(domain, {}, built_rng);
  CHECK(built.roadmap().size() == PrmSettings{}.nodes);
  built.build(domain, {}, built_rng);
  CHECK(built.roadmap().size() == PrmSettings{}.nodes);
  CHECK(built.plan(domain, start, {}, built_rng).states ==
        queried.plan(domain, start, {}, queried_rng).states);
  CHECK(built.roadmap().edges().size() == queried.roadmap().edges().size());
}

TEST_CASE("removing the last nodes restores a roadmap") {
  const ObstacleWorld nothing;
  const DiscDomain domain(nothing, {10, 10}, 0.1, {0, 0}, {1, 1});
  Rng rng(1);
  Roadmap<DiscDomain> map;
  for (int i = 0; i < 50; ++i) map.add(domain, domain.sample(rng), {.neighbours = 5}, 1);
  const std::size_t edges = map.edges().size();
  std::vector<std::vector<std::uint32_t>> edges_before;
  for (std::uint32_t node = 0; node < 50; ++node) edges_before.push_back(map.edges_of(node));
  for (int i = 0; i < 7; ++i) map.add(domain, domain.sample(rng), {Connection::kRadial, 8}, 1);
  REQUIRE(map.edges().size() > edges);
  map.shrink(50);
  CHECK(map.size() == 50);
  CHECK(map.edges().size() == edges);
  for (std::uint32_t node = 0; node < 50; ++node) CHECK(map.edges_of(node) == edges_before[node]);
}

}  // namespace sidestep::prm_test
