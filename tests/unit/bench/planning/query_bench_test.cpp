// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/query_bench.hpp"

#include <set>

#include "agents/planning/visibility/tangent_graph.hpp"
#include "tests/catch.hpp"

namespace sidestep::query_bench_test {

using Answer = std::function<TimedPlan(const BenchmarkWorld&, const PlanQuery&)>;

BenchPlanner planner_of(std::string name, const Answer& answer) {
  return {std::move(name), "", false, [answer](const BenchmarkWorld& world, std::uint64_t) -> QueryFunction {
            return [&world, answer](const PlanQuery& query, double) { return answer(world, query); };
          }};
}

/// The correct answer to a query: the shortest path.
TimedPlan right_answer(const BenchmarkWorld& world, const PlanQuery& query) {
  TangentGraph graph(world.obstacles, world.world.field, world.world.radius_m);
  const std::vector<Vec2> path = graph.plan(query.start_m, query.goal_m).states;
  return {true, 5, 2, 3, path, path};
}

BenchPlanner namesake(BenchPlanner planner, const std::string& peer) {
  planner.baseline = peer;
  planner.is_namesake = true;
  return planner;
}

std::vector<std::string> failures(const std::vector<BenchPlanner>& planners) {
  const std::vector<PlanWorld> worlds{make_world("u", 20, 1), make_world("u", 20, 2)};
  return query_bench_failures(bench_queries(worlds, planners, 10, 1), planners);
}

TEST_CASE("the benchmark passes planners with valid paths and counts their work") {
  const BenchPlanner good = planner_of("good", right_answer);
  const std::vector<PlanWorld> worlds{make_world("u", 20, 1), make_world("u", 15, 2)};
  const auto rows = bench_queries(worlds, {good}, 10, 1);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].queries == 35);
  CHECK(rows[0].solved == 35);
  CHECK(rows[0].invalid == 0);
  CHECK(rows[0].plan_us.median() == 5);
  CHECK(rows[0].with_smoothing_us.median() == 7);
  CHECK(rows[0].length.median() == Approx(1).epsilon(1e-3));
  CHECK(query_bench_failures(rows, {good}).empty());
}

TEST_CASE("the benchmark fails a planner whose path leads through an obstacle") {
  const auto found = failures({planner_of("good", right_answer),
                               planner_of("reckless", [](const BenchmarkWorld&, const PlanQuery& query) {
                                 const std::vector<Vec2> straight{query.start_m, query.goal_m};
                                 return TimedPlan{true, 1, 1, 1, straight, straight};
                               })});
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], StartsWith("reckless: ") && ContainsSubstring("not valid"));
}

TEST_CASE(
    "the benchmark fails a path that is invalid only after smoothing or does not connect start and goal") {
  const int fault = GENERATE(0, 1, 2, 3);
  CAPTURE(fault);
  const auto found =
      failures({planner_of("faulty", [fault](const BenchmarkWorld& world, const PlanQuery& query) {
        TimedPlan plan = right_answer(world, query);
        if (fault == 0) plan.smoothed_m = {query.start_m, query.goal_m};
        if (fault == 1) plan.path_m.pop_back();
        if (fault == 2) plan.path_m.erase(plan.path_m.begin());
        if (fault == 3) plan.path_m.clear();
        return plan;
      })});
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], StartsWith("faulty: "));
}

TEST_CASE("the benchmark does not check the path of a planner that gave up") {
  CHECK(failures({planner_of("silent", [](const BenchmarkWorld&, const PlanQuery&) {
          return TimedPlan{};
        })}).empty());
}

TEST_CASE("a planner fails if it solves significantly fewer queries than its namesake") {
  const auto gives_up_every = [](int nth) {
    return [nth, count = std::make_shared<int>(0)](const BenchmarkWorld& world, const PlanQuery& query) {
      return ++*count % nth == 0 ? TimedPlan{} : right_answer(world, query);
    };
  };
  const BenchPlanner peer = planner_of("peer", right_answer);
  CHECK(failures({peer, namesake(planner_of("equal", right_answer), "peer")}).empty());
  CHECK(failures({peer, namesake(planner_of("unlucky once", gives_up_every(30)), "peer")}).empty());
  CHECK(failures({peer, planner_of("another", gives_up_every(4))}).empty());
  CHECK(failures({namesake(planner_of("alone", gives_up_every(4)), "peer")}).empty());
  const auto found = failures({peer, namesake(planner_of("weak", gives_up_every(4)), "peer")});
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0], StartsWith("weak solved 30 of 40 queries, its peer peer 40 of 40"));
  // It is not a failure if the namesake, the OMPL planner, is weaker.
  CHECK(failures({planner_of("weak peer", gives_up_every(4)), namesake(peer, "weak peer")}).empty());
}

TEST_CASE("every planner gets every query once, in blocks whose order the seed shuffles") {
  constexpr std::size_t kQueries = 50 * kBlock;
  const auto sequence = [](std::uint64_t seed) {
    std::vector<std::pair<std::string, double>> asked;
    std::vector<BenchPlanner> planners;
    for (const std::string name : {"a", "b", "c"})
      planners.push_back(planner_of(name, [name, &asked](const BenchmarkWorld&, const PlanQuery& query) {
        asked.emplace_back(name, query.start_m.x());
        return TimedPlan{};
      }));
    static_cast<void>(bench_queries({make_world("empty", kQueries, 1)}, planners, 10, seed));
    return asked;
  };
  const auto asked = sequence(1);
  const PlanWorld world = make_world("empty", kQueries, 1);
  REQUIRE(asked.size() == 3 * (kQueries + 1));  // includes one warm-up query per planner
  std::set<std::string> orders;
  for (std::size_t block = 0; block < kQueries; block += kBlock) {
    std::string order;
    for (std::size_t i = 0; i < 3; ++i) {
      order += asked[3 + 3 * block + kBlock * i].first;
      for (std::size_t k = 0; k < kBlock; ++k) {
        const auto& [name, start_x] = asked[3 + 3 * block + kBlock * i + k];
        CHECK(name == order.substr(i));
        CHECK(start_x == world.queries[block + k].start_m.x());
      }
    }
    CHECK(std::set<char>(order.begin(), order.end()).size() == 3);
    orders.insert(order);
  }
  CHECK(orders.size() == 6);
  CHECK(sequence(1) == asked);
  CHECK(sequence(2) != asked);
}

TEST_CASE("a table has ratios of medians, and a 99th percentile only from a thousand queries on") {
  const std::vector<BenchPlanner> planners{{"peer", "", false, {}}, {"ours", "peer", true, {}}};
  const std::size_t queries = GENERATE(999u, 1000u);
  std::vector<QueryBenchRow> rows(2);
  for (std::size_t i = 0; i < 2; ++i) {
    rows[i].planner = planners[i].name;
    rows[i].queries = rows[i].solved = queries;
    for (std::size_t k = 0; k < queries; ++k) rows[i].plan_us.add(i == 0 ? 1234.5 : 617.25);
  }
  const std::string lines = query_bench_lines("u", rows, planners);
  CHECK_THAT(lines, ContainsSubstring("0.50"));
  std::size_t times = 0;
  for (std::size_t at = lines.find("1234.5"); at != std::string::npos; at = lines.find("1234.5", at + 1))
    ++times;
  CHECK(times == (queries < 1000 ? 2 : 3));  // median, p95, p99
}

}  // namespace sidestep::query_bench_test
