// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "agents/safety/safety_search.hpp"
#include "common/motion/robot_model.hpp"
#include "coordinator/ledger.hpp"
#include "tests/bench/streams.hpp"

using namespace sidestep;

namespace {

/// For each robot in turn, one grant and the report that releases its previous version. The argument is the
/// number of robots from the crossing streams. Proposals are random accelerations within the robot's limits.
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
  for (std::size_t i = 0; i < robots; ++i) ledger.register_robot(newest[i].robot, {&newest[i], 1});
  const MotionLimits& limits = snapshot.scenario.limits;
  const Duration cycle = snapshot.scenario.cycle;
  Rng rng(3);
  std::size_t i = 0, granted = 0;
  for (auto _ : state) {
    Version& last = newest[i];
    const Time start = last.trajectory.start() + cycle;
    const State there = last.trajectory.state_at(start);
    const Vec2 drawn = limit_acceleration(sample_acceleration(there.velocity_mps, limits, rng),
                                          there.velocity_mps, limits, cycle);
    const Version next{last.robot,
                       last.incarnation,
                       last.number + 1,
                       last.number,
                       accelerate_then_stop(start, there, drawn, cycle, limits.deceleration_mps2),
                       0};
    if (ledger.grant(next).is_granted()) {
      ++granted;
      (void)ledger.on_executing(next, start, false);
      last = next;
    }
    i = (i + 1) % robots;
  }
  state.counters["granted"] = static_cast<double>(granted) / static_cast<double>(state.iterations());
}
BENCHMARK(grant_of_one_version)->ArgName("robots")->Arg(22)->Arg(100)->Arg(1000);

}  // namespace
