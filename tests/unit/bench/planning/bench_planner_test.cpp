// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/bench_planner.hpp"

#include <algorithm>

#include "agents/planning/named_planner.hpp"
#include "tests/bench/planning/ompl_planner.hpp"
#include "tests/bench/planning/query_bench.hpp"
#include "tests/catch.hpp"

namespace sidestep::bench_planner_test {

std::vector<std::string> names_of(const std::vector<BenchPlanner>& planners) {
  std::vector<std::string> names;
  for (const BenchPlanner& planner : planners) names.push_back(planner.name);
  return names;
}

TEST_CASE("the benchmark contains each of our planners and each OMPL planner exactly once") {
  std::vector<std::string> names = names_of(bench_planners()), expected = planner_names();
  expected.insert(expected.end(), ompl_planner_names().begin(), ompl_planner_names().end());
  std::sort(names.begin(), names.end());
  std::sort(expected.begin(), expected.end());
  CHECK(names == expected);
}

TEST_CASE("only RRT and RRTConnect are compared with OMPL planners of the same name") {
  for (const BenchPlanner& planner : bench_planners()) {
    CAPTURE(planner.name);
    const bool has_peer =
        !ompl_planner_names().empty() && (planner.name == "rrt" || planner.name == "rrt-connect");
    CHECK(planner.is_namesake == has_peer);
    if (planner.is_namesake)
      CHECK(planner.baseline == (planner.name == "rrt" ? "ompl-RRT" : "ompl-RRTConnect"));
  }
}

TEST_CASE("selecting one of our planners also selects its namesake in OMPL") {
  CHECK(select_planners(bench_planners(), {}).size() == bench_planners().size());
  CHECK(names_of(select_planners(bench_planners(), {"bi-errt"})) == std::vector<std::string>{"bi-errt"});
  const auto selected = names_of(select_planners(bench_planners(), {"rrt"}));
  CHECK(selected.size() == (ompl_planner_names().empty() ? 1 : 2));
}

TEST_CASE("every planner in the benchmark returns a valid path and its planning time") {
  const BenchmarkWorld world(make_world("u", 3, 1));
  for (const BenchPlanner& planner : bench_planners()) {
    CAPTURE(planner.name);
    const QueryFunction plan = planner.prepare(world, 1);
    for (const PlanQuery& query : world.world.queries) {
      const TimedPlan timed = plan(query, 2000);
      REQUIRE(timed.is_solved);
      CHECK(timed.plan_us > 0);
      CHECK(timed.smoothing_us > 0);
      CHECK(is_valid_path(world.world, timed.path_m, 1e-9));
      CHECK(is_valid_path(world.world, timed.smoothed_m, 1e-9));
      CHECK(timed.smoothed_m.back() == query.goal_m);
    }
  }
}

TEST_CASE("a planner gives up on a query at its time limit") {
  // A wall separates start and goal.
  PlanWorld closed;
  closed.obstacles = {Box{{-0.1, -6}, {0.1, 6}}};
  closed.queries = {{{-3, 0}, {3, 0}}};
  const BenchmarkWorld world(closed);
  for (const std::string name : {"rrt", "rrt-connect", "ompl-RRT", "ompl-RRTConnect", "ompl-KPIECE"}) {
    for (const BenchPlanner& planner : select_planners(bench_planners(), {name})) {
      CAPTURE(planner.name);
      const TimedPlan timed = planner.prepare(world, 1)(closed.queries[0], 5);
      CHECK_FALSE(timed.is_solved);
      CHECK(timed.plan_us >= 5000);
      CHECK(timed.plan_us < 50'000);
    }
  }
}

TEST_CASE("our planners need about as many iterations as their namesakes in OMPL") {
  const std::string world = GENERATE(as<std::string>(), "maze", "circles");
  std::vector<PlanWorld> worlds;
  for (const std::uint64_t seed : {1, 2, 3, 4}) worlds.push_back(make_world(world, 100, seed));
  const auto planners = select_planners(bench_planners(), {"rrt", "rrt-connect"});
  const auto rows = bench_queries(worlds, planners, 2000, 1);
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2) {
    CAPTURE(world, rows[i].planner, rows[i + 1].planner);
    CHECK(planners[i + 1].baseline == rows[i].planner);
    CHECK(rows[i].iterations.median() == Approx(rows[i + 1].iterations.median()).epsilon(0.3));
    CHECK(rows[i].length.median() == Approx(rows[i + 1].length.median()).epsilon(0.05));
  }
}

TEST_CASE("planted planners have the faults that their names state, and unknown names are rejected") {
  const BenchmarkWorld world(make_world("u", 8, 1));
  const QueryFunction invalid = planted_planner("invalid-path").prepare(world, 1);
  const QueryFunction weak = planted_planner("weak-namesake").prepare(world, 1);
  int solved = 0;
  for (const PlanQuery& query : world.world.queries) {
    const TimedPlan timed = invalid(query, 100);
    CHECK(timed.is_solved);
    CHECK_FALSE(is_valid_path(world.world, timed.path_m, 1e-9));
    solved += weak(query, 1000).is_solved;
  }
  CHECK(solved == 6);
  CHECK_THROWS_WITH(planted_planner("rrt"), ContainsSubstring("\"rrt\""));
}

}  // namespace sidestep::bench_planner_test
