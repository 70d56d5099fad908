// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/commanded_motion.hpp"

#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::commanded_motion_test {

using namespace std::chrono_literals;

TEST_CASE("a base executes its commands after its latency") {
  const Time begin = time_from_ns(1'000'000'000'000);
  CommandedMotion motion(100ms);
  CHECK(motion.mean(begin, begin + 10ms).linear_mps == Vec2(0, 0));
  motion.add(begin, {{1, 0}, 2});
  motion.add(begin + 10ms, {{3, 0}, 0});
  CHECK(motion.mean(begin + 90ms, begin + 100ms).linear_mps == Vec2(0, 0));
  CHECK(motion.mean(begin + 100ms, begin + 110ms).linear_mps.x() == Approx(1));
  CHECK(motion.mean(begin + 100ms, begin + 110ms).turn_radps == Approx(2));
  CHECK(motion.mean(begin + 105ms, begin + 115ms).linear_mps.x() == Approx(2));
  CHECK(motion.mean(begin + 95ms, begin + 105ms).linear_mps.x() == Approx(0.5));
  CHECK(motion.mean(begin + 200ms, begin + 300ms).linear_mps.x() == Approx(3));
  CHECK(motion.latest().linear_mps.x() == 3);
}

TEST_CASE("the mean of the commanded velocities equals a numerical integral") {
  Rng rng(5);
  const Time begin = time_from_ns(1'000'000'000'000);
  CommandedMotion motion(70ms);
  struct Sent {
    Time at;
    double speed_mps;
  };
  std::vector<Sent> sent;
  Time now = begin;
  for (int i = 0; i < 200; ++i) {
    now += Duration{static_cast<std::int64_t>(rng.uniform(5e6, 15e6))};
    sent.push_back({now, rng.uniform(-2.0, 2.0)});
    motion.add(now, {{sent.back().speed_mps, 0}, 0});
  }
  for (int i = 0; i < 100; ++i) {
    const Time from = begin + Duration{static_cast<std::int64_t>(rng.uniform(2e8, 1.5e9))};
    const Duration length{static_cast<std::int64_t>(rng.uniform(1e6, 1e8))};
    double sum = 0;
    constexpr int kSteps = 4000;
    for (int k = 0; k < kSteps; ++k) {
      const Time at = from + length * (2 * k + 1) / (2 * kSteps) - 70ms;
      double speed = 0;
      for (const Sent& one : sent) {
        if (one.at <= at) speed = one.speed_mps;
      }
      sum += speed / kSteps;
    }
    CHECK(motion.mean(from, from + length).linear_mps.x() == Approx(sum).margin(0.002));
  }
}

}  // namespace sidestep::commanded_motion_test
