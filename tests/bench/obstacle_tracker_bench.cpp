// SPDX-License-Identifier: Apache-2.0
// The time that vision takes to track obstacles and to list them.
#include <benchmark/benchmark.h>
#include <cmath>
#include <vector>

#include "common/messaging/detected_obstacles.hpp"
#include "common/random/rng.hpp"
#include "vision/tracking/obstacle_tracker.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod{16'666'667};
constexpr Time kBegin = time_from_ns(1'000'000'000'000);

/// Frames of obstacles that move on circles at 1 m/s, with 1.5 m² of floor for each.
std::vector<Frame> frames_of_walkers(std::size_t count, int frames) {
  Rng rng(1);
  const double half_m = 0.5 * std::sqrt(1.5 * static_cast<double>(count));
  std::vector<Vec2> centres_m;
  for (std::size_t i = 0; i < count; ++i)
    centres_m.emplace_back(rng.uniform(-half_m, half_m), rng.uniform(-half_m, half_m));
  std::vector<Frame> result(static_cast<std::size_t>(frames));
  for (int k = 0; k < frames; ++k) {
    const Time t = kBegin + k * kPeriod;
    std::vector<Circle> seen;
    for (const Vec2& centre_m : centres_m) {
      const Vec2 arm = rotated({1, 0}, to_seconds(k * kPeriod));
      seen.push_back({centre_m + arm + 0.0015 * Vec2(rng.normal(), rng.normal()), 0.2});
    }
    msg::DetectionFrame message;
    message.captured_at_ns(to_ns(t));
    set_obstacles(seen, message);
    result[static_cast<std::size_t>(k)].assign(message, t);
  }
  return result;
}

/// One frame and one list with 22 robots.
void track_obstacles(benchmark::State& state) {
  constexpr int kFrames = 120;
  const std::vector<Frame> frames = frames_of_walkers(static_cast<std::size_t>(state.range(0)), kFrames);
  std::vector<msg::TrackedRobot> robots(22);
  for (std::size_t i = 0; i < robots.size(); ++i) robots[i].x_m(0.5 * static_cast<double>(i) - 5);
  msg::ObstacleList list;
  ObstacleTracker tracker({});
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == frames.size()) {
      state.PauseTiming();
      tracker = ObstacleTracker({});
      next = 0;
      state.ResumeTiming();
    }
    tracker.update(frames[next]);
    tracker.list_at(frames[next].captured_at(), robots, list);
    ++next;
  }
  state.counters["listed"] = static_cast<double>(list.obstacles().size());
}
BENCHMARK(track_obstacles)->Arg(32)->Arg(256)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace sidestep
