// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include "common/motion/clearance.hpp"
#include "agents/safety/clearance_batch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

namespace {

const Time kStart = time_from_ns(1'000'000'000);
constexpr Duration kCycle{16'666'667};
constexpr std::size_t kOthers = 32, kCandidates = 8, kRounds = 64;
constexpr double kKeep_m = 0.19;

Trajectory version_like(Rng& rng, double half_side_m) {
  Trajectory trajectory(
      kStart + Duration{static_cast<std::int64_t>(rng.below(16'000'000))},
      {random_vector(rng, half_side_m), rng.uniform(0, 2) * rotated({1, 0}, rng.uniform(-3.2, 3.2))});
  trajectory.append(kCycle, random_vector(rng, 2));
  append_stop(trajectory, 5);
  return trajectory;
}

/// Versions as searches and ledgers compare them, the candidates of one robot with what others may be
/// executing, all in a square with sides of so many times 2 cm.
struct Pairs {
  explicit Pairs(std::int64_t half_side_cm) {
    Rng rng(1);
    for (std::size_t i = 0; i < kRounds; ++i) {
      const Trajectory one = version_like(rng, static_cast<double>(half_side_cm) / 100);
      for (std::size_t k = 0; k < kCandidates; ++k) {
        ones.push_back({one.start(), one.at_start()});
        ones.back().append(kCycle, random_vector(rng, 2));
        append_stop(ones.back(), 5);
      }
    }
    for (std::size_t i = 0; i < kRounds * kOthers; ++i) {
      others.push_back(version_like(rng, static_cast<double>(half_side_cm) / 100));
      outlines.push_back(trajectory_bounds(others.back()));
    }
  }
  std::vector<Trajectory> ones, others;
  std::vector<TrajectoryBounds> outlines;
};

void report(benchmark::State& state, std::size_t clear) {
  const auto pairs = static_cast<double>(state.iterations()) * kOthers * kCandidates;
  state.counters["ns_per_pair"] =
      benchmark::Counter(pairs * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["clear"] = static_cast<double>(clear) / pairs;
}

void pairs_one_by_one(benchmark::State& state) {
  const Pairs pairs(state.range(0));
  std::size_t round = 0, clear = 0;
  for (auto _ : state) {
    round = (round + 1) % kRounds;
    for (std::size_t k = 0; k < kCandidates; ++k) {
      const Trajectory& one = pairs.ones[round * kCandidates + k];
      for (std::size_t i = 0; i < kOthers; ++i)
        clear += is_clear(one, pairs.others[round * kOthers + i], kKeep_m) ? 1 : 0;
    }
  }
  report(state, clear);
}

void pairs_in_a_batch(benchmark::State& state, const batch::Kernels* kernels) {
  const Pairs pairs(state.range(0));
  ClearanceBatch batch(*kernels);
  std::size_t round = 0, clear = 0;
  for (auto _ : state) {
    round = (round + 1) % kRounds;
    batch.restart(pairs.ones[round * kCandidates].start());
    for (std::size_t i = round * kOthers; i < (round + 1) * kOthers; ++i)
      batch.add(pairs.outlines[i], pairs.others[i], kKeep_m);
    for (std::size_t k = 0; k < kCandidates; ++k) {
      for (const std::uint8_t one : batch.compare(pairs.ones[round * kCandidates + k])) clear += one;
    }
  }
  report(state, clear);
  state.counters["left_to_exact"] = static_cast<double>(batch.left_to_exact()) /
                                    (static_cast<double>(state.iterations()) * kOthers * kCandidates);
}

const int kRegistered = [] {
  for (const std::int64_t half_side_cm : {20, 50, 200}) {
    benchmark::RegisterBenchmark("pairs_one_by_one", pairs_one_by_one)
        ->ArgName("half_side_cm")
        ->Arg(half_side_cm);
    for (const batch::Kernels& kernels : batch::available_kernels()) {
      benchmark::RegisterBenchmark((std::string("pairs_in_a_batch/") + kernels.name).c_str(),
                                   pairs_in_a_batch, &kernels)
          ->ArgName("half_side_cm")
          ->Arg(half_side_cm);
    }
  }
  return 0;
}();

}  // namespace
