// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <benchmark/benchmark.h>
#include <chrono>

#include "tests/bench/streams.hpp"

using namespace sidestep;

namespace {

/// All versions of the robots nearest to the centre of the crossing streams.
std::vector<Version> versions_of(std::size_t robots) {
  std::vector<Version> versions;
  for (std::size_t i = 0; i < robots; ++i) {
    const auto& robot = bench::crossing_streams().robots[i];
    versions.insert(versions.end(), robot.versions.begin(), robot.versions.end());
  }
  return versions;
}

/// One search per robot and cycle, for all robots in turn. The index is rebuilt in each cycle.
void search_per_robot(benchmark::State& state, const batch::Kernels* kernels) {
  const auto& snapshot = bench::crossing_streams();
  const auto robots = static_cast<std::size_t>(state.range(0));
  const std::vector<Version> versions = versions_of(robots);
  SafetySearch search(floor_rules(snapshot.scenario), *kernels);
  TrajectoryIndex index(*kernels);
  Rng rng(2);
  std::size_t i = 0, desired_clear = 0, candidates = 0, checks = 0;
  std::vector<double> each_us;
  each_us.reserve(1 << 22);
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    if (i == 0) index.assign(versions);
    const auto& robot = snapshot.robots[i];
    SearchQuery query = robot.query;
    query.robot = robot.versions.front().robot;
    const auto result = search.search(query, index, rng);
    const auto end = std::chrono::steady_clock::now();
    if (each_us.size() < each_us.capacity())
      each_us.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    desired_clear += result.desired_is_clear ? 1 : 0;
    candidates += result.count;
    checks += static_cast<std::size_t>(result.checks);
    i = (i + 1) % robots;
  }
  const auto average = [&](std::size_t sum) {
    return static_cast<double>(sum) / static_cast<double>(state.iterations());
  };
  state.counters["desired_clear"] = average(desired_clear);
  state.counters["candidates"] = average(candidates);
  state.counters["checks"] = average(checks);
  const auto median = each_us.begin() + static_cast<std::ptrdiff_t>(each_us.size() / 2);
  std::nth_element(each_us.begin(), median, each_us.end());
  state.counters["median_us"] = *median;
}

const int kRegistered = [] {
  for (const batch::Kernels& kernels : batch::available_kernels()) {
    for (const std::int64_t robots : {2, 20, 100, 1000}) {
      benchmark::RegisterBenchmark((std::string("search_per_robot/") + kernels.name).c_str(),
                                   search_per_robot, &kernels)
          ->ArgName("robots")
          ->Arg(robots);
    }
  }
  return 0;
}();

}  // namespace
