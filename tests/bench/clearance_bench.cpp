// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "common/motion/clearance.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(1'000'000'000);
constexpr Duration kCycle{16'666'667};
constexpr std::size_t kOthers = 32, kCandidates = 8, kRounds = 64;
constexpr double kMinSeparation_m = 0.19;

Trajectory typical_version(Rng& rng, double half_side_m) {
  const Vec2 position = random_vector(rng, half_side_m), velocity = random_velocity(rng, 2, 3.2);
  Trajectory trajectory(kStart + Duration{static_cast<std::int64_t>(rng.below(16'000'000))},
                        {position, velocity});
  trajectory.append(kCycle, random_vector(rng, 2));
  append_stop(trajectory, 5);
  return trajectory;
}

/// The candidates of one robot and the versions of others in each round, all within a square.
struct Pairs {
  explicit Pairs(std::int64_t half_side_cm) {
    Rng rng(1);
    const double half_side_m = static_cast<double>(half_side_cm) / 100;
    for (std::size_t i = 0; i < kRounds; ++i) {
      const Trajectory first = typical_version(rng, half_side_m);
      for (std::size_t k = 0; k < kCandidates; ++k) {
        candidates.push_back({first.start(), first.at_start()});
        candidates.back().append(kCycle, random_vector(rng, 2));
        append_stop(candidates.back(), 5);
      }
    }
    for (std::size_t i = 0; i < kRounds * kOthers; ++i) others.push_back(typical_version(rng, half_side_m));
  }
  std::vector<Trajectory> candidates, others;
};

void exact_clearance(benchmark::State& state) {
  const Pairs pairs(state.range(0));
  std::size_t round = 0, clear = 0;
  for (auto _ : state) {
    round = (round + 1) % kRounds;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      const Trajectory& candidate = pairs.candidates[round * kCandidates + k];
      for (std::size_t i = 0; i < kOthers; ++i)
        clear += is_clear(candidate, pairs.others[round * kOthers + i], kMinSeparation_m) ? 1 : 0;
    }
  }
  const auto count = static_cast<double>(state.iterations()) * kOthers * kCandidates;
  state.counters["ns_per_pair"] =
      benchmark::Counter(count * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["clear"] = static_cast<double>(clear) / count;
}
BENCHMARK(exact_clearance)->ArgName("half_side_cm")->Arg(20)->Arg(50)->Arg(200);

}  // namespace
