// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "agents/safety/safety_search.hpp"
#include "coordinator/ledger.hpp"
#include "tests/bench/streams.hpp"

using namespace sidestep;

namespace {

/// One grant and the fact that frees it, to each robot in turn, among so many in crossing streams. Every
/// robot goes on as it does or brakes, whichever is granted.
void grant_of_one_version(benchmark::State& state) {
  const auto& snapshot = bench::crossing_streams();
  const auto robots = static_cast<std::size_t>(state.range(0));
  std::vector<RobotId> roster;
  std::vector<Version> newest;
  for (std::size_t i = 0; i < robots; ++i) {
    newest.push_back(*std::ranges::max_element(snapshot.robots[i].versions, {}, &Version::number));
    roster.push_back(newest.back().robot);
  }
  Ledger ledger(floor_rules(snapshot.scenario), roster);
  for (std::size_t i = 0; i < robots; ++i) (void)ledger.enter(newest[i].robot, {&newest[i], 1});
  std::size_t i = 0, granted = 0, cycle = 1;
  for (auto _ : state) {
    Version& last = newest[i];
    const Time start = last.trajectory.start() + snapshot.scenario.cycle;
    const State there = last.trajectory.state_at(start);
    const Vec2 ahead = cycle % 64 < 32 ? there.velocity_mps : Vec2(-there.velocity_mps);
    const Version next{last.robot,
                       last.incarnation,
                       last.number + 1,
                       last.number,
                       accelerate_then_stop(start, there, 0.1 * ahead, snapshot.scenario.cycle,
                                            snapshot.scenario.limits.deceleration_mps2),
                       0};
    if (ledger.grant(next).granted()) {
      ++granted;
      (void)ledger.forget(next.robot, next.number, start);
      last = next;
    }
    i = (i + 1) % robots;
    cycle += i == 0 ? 1 : 0;
  }
  state.counters["granted"] = static_cast<double>(granted) / static_cast<double>(state.iterations());
}
BENCHMARK(grant_of_one_version)->ArgName("robots")->Arg(22)->Arg(100)->Arg(1000);

}  // namespace
