// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/latency_fit.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::latency_fit_test {

using namespace std::chrono_literals;

/// Eight starts in all directions, seen 60 times a second with this noise.
LatencyFit fit_of(Duration late, double noise_m, std::uint64_t seed) {
  Rng rng(seed);
  LatencyFit fit;
  Time begin = time_from_ns(1'700'000'000'000'000'000);
  for (int start = 0; start < 8; ++start, begin += 3s) {
    Trajectory trajectory(begin, {Vec2(0, 0), Vec2(0, 0)});
    trajectory.append(250ms, rotated(Vec2(2.4, 0), start * 0.785));
    append_stop(trajectory, 5);
    fit.begin_start(trajectory);
    for (Time at = begin + 25ms; at < begin + 200ms; at += 16ms) {
      const Vec2 noise_m2(noise_m * rng.normal(), noise_m * rng.normal());
      fit.add(at, trajectory.state_at(at - late).position_m + noise_m2);
    }
  }
  return fit;
}

TEST_CASE("a latency without noise is found exactly, and is certain") {
  const Duration late = GENERATE(-60ms, -7ms, 0ms, 18ms, 130ms);
  const LatencyFit::Result result = fit_of(late, 0, 1).result();
  CHECK(std::abs(to_seconds(result.late - late)) < 1e-4);
  CHECK(to_seconds(result.uncertainty) < 5e-4);
}

TEST_CASE("nearly all latencies are within the stated uncertainty, which grows with the noise") {
  int within = 0;
  double uncertainty_s = 0;
  const double noise_m = GENERATE(0.0005, 0.003);
  constexpr int kTrials = 1000;
  for (int seed = 1; seed <= kTrials; ++seed) {
    const LatencyFit::Result result = fit_of(18ms, noise_m, static_cast<std::uint64_t>(seed)).result();
    uncertainty_s += to_seconds(result.uncertainty) / kTrials;
    within += std::abs(to_seconds(result.late - 18ms)) <= to_seconds(result.uncertainty) ? 1 : 0;
  }
  CAPTURE(noise_m, within, uncertainty_s);
  CHECK(within >= 0.93 * kTrials);
  CHECK(uncertainty_s > 0.2 * noise_m);
  CHECK(uncertainty_s < 3 * noise_m);
}

TEST_CASE("the latency of a single start is not certain") {
  LatencyFit fit;
  const Time begin = time_from_ns(1'700'000'000'000'000'000);
  Trajectory trajectory(begin, {Vec2(0, 0), Vec2(0, 0)});
  trajectory.append(250ms, Vec2(2, 0));
  append_stop(trajectory, 5);
  fit.begin_start(trajectory);
  fit.add(begin + 100ms, {0.01, 0});
  CHECK(fit.observations() == 1);
  CHECK(fit.result().uncertainty == LatencyFit::kMaxLate);
}

}  // namespace sidestep::latency_fit_test
