// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_error.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::clock_error_test {

using namespace std::chrono_literals;

TEST_CASE("a clock that drifts by one part per million gains a microsecond per second") {
  const ClockError clock{3ms, 1, Time{1000s}};
  CHECK(clock.reading(Time{1000s}) == Time{1000s + 3ms});
  CHECK(clock.reading(Time{1010s}) == Time{1010s + 3ms + 10us});
  CHECK(ClockError{-3ms}.reading(Time{1010s}) == Time{1010s - 3ms});
}

TEST_CASE("a reading is converted to the first true time at which the clock shows it") {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    CAPTURE(i);
    const double drift_ppm = rng.chance(0.2) ? 0 : rng.uniform(-1000, 1000);
    const ClockError clock{from_seconds(rng.uniform(-5, 5)), drift_ppm, Time{1000s}};
    const Time shown = Time{1000s} + from_seconds(rng.uniform(-1, 100));
    const Time t = clock.true_time(shown);
    REQUIRE(clock.reading(t) >= shown);
    REQUIRE(clock.reading(t - 1ns) < shown);
  }
}

}  // namespace sidestep::clock_error_test
