// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/simulated_clock.hpp"

#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"

namespace sidestep::simulated_clock_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

double seconds_between(Time from, Time to) { return to_seconds(to - from); }

TEST_CASE("simulated time is the integral of speeds that take turns, and converts back to real time") {
  PaceSettings pace;
  pace.speeds = {0.98, 0.66, 1.02, 0.5};
  pace.speed_duration = 700ms;
  SimulatedClock clock(kBegin, pace, 1);
  double integral_s = 0;
  for (int ms = 0; ms < 20'000; ++ms) {
    const Time now = kBegin + std::chrono::milliseconds(ms);
    const Time simulated = clock.simulated(now);
    REQUIRE(std::abs(seconds_between(kBegin, simulated) - integral_s) < 1e-6);
    REQUIRE(std::abs(seconds_between(clock.clock(simulated), now)) < 1e-6);
    integral_s += 0.001 * pace.speeds[static_cast<std::size_t>(ms / 700 % 4)];
  }
  // Earlier times convert by the speeds of their time.
  const Time before = kBegin + 19'000ms;
  const double before_s = 0.7 * 6 * (0.98 + 0.66 + 1.02 + 0.5) + 0.7 * (0.98 + 0.66 + 1.02) + 0.1 * 0.5;
  CHECK(std::abs(seconds_between(clock.clock(kBegin + from_seconds(before_s)), before)) < 1e-6);
}

TEST_CASE("calls at long intervals give the same simulated time as frequent calls") {
  PaceSettings pace;
  pace.speeds = {0.5, 1.02};
  pace.speed_duration = 100ms;
  SimulatedClock often(kBegin, pace, 1), rarely(kBegin, pace, 1);
  for (int ms = 0; ms <= 10'000; ++ms) often.simulated(kBegin + std::chrono::milliseconds(ms));
  CHECK(often.simulated(kBegin + 10s) == rarely.simulated(kBegin + 10s));
}

TEST_CASE("a speed that is set ends the turns of speeds") {
  PaceSettings pace;
  pace.speeds = {0.5, 1};
  pace.speed_duration = 1s;
  SimulatedClock clock(kBegin, pace, 1);
  clock.set_speed(2, kBegin + 1500ms);
  CHECK(seconds_between(kBegin, clock.simulated(kBegin + 10s)) == Approx(0.5 + 0.5 + 2 * 8.5));
}

TEST_CASE("simulated time advances in whole steps, which are late by at most the given delay") {
  PaceSettings pace;
  pace.speeds = {0.98};
  pace.step = from_seconds(1.0 / 60);
  pace.max_step_delay = GENERATE(Duration(0), Duration(8ms), Duration(50ms));
  CAPTURE(to_seconds(pace.max_step_delay));
  SimulatedClock clock(kBegin, pace, 3);
  Time last = kBegin;
  Duration max_delay{0};
  for (int i = 0; i < 200'000; ++i) {
    const Duration real = i * 100us;
    const Duration simulated = clock.simulated(kBegin + real) - kBegin;
    REQUIRE(simulated.count() % pace.step.count() == 0);
    REQUIRE(kBegin + simulated >= last);
    // The next step has not begun yet.
    const Duration delay = from_seconds(0.98 * to_seconds(real)) - simulated - pace.step;
    REQUIRE(delay < pace.max_step_delay + 1us);
    max_delay = std::max(max_delay, delay);
    last = kBegin + simulated;
  }
  CHECK(to_seconds(max_delay) > 0.9 * to_seconds(pace.max_step_delay) - 1e-4);
  CHECK(seconds_between(kBegin, last) == Approx(0.98 * 20).margin(0.07));
}

TEST_CASE("time that was skipped does not pass, and the speed stays") {
  PaceSettings pace;
  pace.speeds = {0.5};
  SimulatedClock clock(kBegin, pace, 1);
  const Time paused = clock.simulated(kBegin + 2s);
  clock.simulated(kBegin + 60s);
  clock.resume(paused, kBegin + 60s);
  CHECK(clock.simulated(kBegin + 60s) == paused);
  CHECK(seconds_between(paused, clock.simulated(kBegin + 64s)) == Approx(2));
  CHECK(clock.clock(paused + 1s) == kBegin + 62s);
  CHECK(clock.clock(paused - 500ms) == kBegin + 1s);
}

}  // namespace sidestep::simulated_clock_test
