// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "agents/safety/safety_search.hpp"
#include "common/motion/clearance.hpp"
#include "coordinator/ledger.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(1'000'000'000);
constexpr Duration kCycle{16'666'667};

Trajectory version_like(Rng& rng, double spread_m) {
  Trajectory trajectory(
      kStart + Duration{static_cast<std::int64_t>(rng.below(16'000'000))},
      {random_vector(rng, spread_m), rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3.2, 3.2))});
  trajectory.append(kCycle, random_vector(rng, 2));
  append_stop(trajectory, 5);
  return trajectory;
}

/// Pairs of versions as the ledger compares them, both within a square of this half side.
void clearance_of_a_pair(benchmark::State& state) {
  Rng rng(1);
  std::vector<std::pair<Trajectory, Trajectory>> pairs;
  const double spread = static_cast<double>(state.range(0)) / 100;
  for (int i = 0; i < 1024; ++i) pairs.emplace_back(version_like(rng, spread), version_like(rng, spread));
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& [a, b] = pairs[i++ % pairs.size()];
    benchmark::DoNotOptimize(is_clear(a, b, 0.19));
  }
}
BENCHMARK(clearance_of_a_pair)->ArgName("half_side_cm")->Arg(20)->Arg(50)->Arg(200);

/// One robot's search in a crowd of so many others at 0.7 m² each.
void search_of_one_robot(benchmark::State& state) {
  Rng rng(2);
  const auto others = static_cast<std::size_t>(state.range(0));
  const double half_side = 0.5 * std::sqrt(0.7 * static_cast<double>(others));
  FloorRules rules;
  rules.field = {100, 100};
  std::vector<Version> versions;
  while (versions.size() < others) {
    const Trajectory trajectory = version_like(rng, half_side);
    if (trajectory.at_start().position_m.norm() < 0.3) continue;
    versions.push_back({static_cast<RobotId>(versions.size() + 1), 1, versions.size() + 1, 0, trajectory});
  }
  SafetySearch search(rules, {});
  std::size_t candidates = 0, checks = 0;
  for (auto _ : state) {
    const SearchQuery query{kStart, {{0, 0}, random_vector(rng, 1)}, random_vector(rng, 3), kCycle};
    const auto result = search.search(query, versions, rng);
    candidates += result.count;
    checks += static_cast<std::size_t>(result.checks);
  }
  state.counters["candidates"] =
      benchmark::Counter(static_cast<double>(candidates), benchmark::Counter::kAvgIterations);
  state.counters["checks"] =
      benchmark::Counter(static_cast<double>(checks), benchmark::Counter::kAvgIterations);
}
BENCHMARK(search_of_one_robot)->ArgName("others")->Arg(2)->Arg(20)->Arg(100)->Arg(1000);

/// One grant and the fact that frees it, with so many robots in the ledger, 0.7 m apart.
void grant_of_one_version(benchmark::State& state) {
  FloorRules rules;
  rules.field = {200, 200};
  const auto robots = static_cast<RobotId>(state.range(0));
  std::vector<RobotId> roster;
  for (RobotId robot = 0; robot < robots; ++robot) roster.push_back(robot);
  Ledger ledger(rules, roster);
  Version last;
  for (const RobotId robot : roster) {
    const Vec2 place(0.7 * (robot % 32) - 11, 0.7 * (robot / 32) - 11);
    const Version stand{robot, 0, 0, 0, Trajectory::resting(kStart, place)};
    (void)ledger.enter(robot, {&stand, 1});
    if (robot == robots / 2) last = stand;
  }
  Rng rng(3);
  std::size_t granted = 0;
  Time start = last.trajectory.start();
  for (auto _ : state) {
    start += kCycle;
    const State there = last.trajectory.state_at(start);
    Version next{last.robot, 1, last.number + 1, last.number,
                 accelerate_then_stop(start, there, rng.uniform(0, 1) * rotated({1, 0}, rng.uniform(-3, 3)),
                                      kCycle, 5)};
    if (!ledger.grant(next).granted()) continue;
    ++granted;
    (void)ledger.forget(next.robot, next.number, start);
    last = next;
  }
  state.counters["granted"] =
      benchmark::Counter(static_cast<double>(granted), benchmark::Counter::kAvgIterations);
}
BENCHMARK(grant_of_one_version)->ArgName("robots")->Arg(22)->Arg(100)->Arg(1000);

}  // namespace

BENCHMARK_MAIN();
