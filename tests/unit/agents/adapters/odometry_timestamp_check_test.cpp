// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/odometry_timestamp_check.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::odometry_timestamp_check_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

TEST_CASE("after a report that arrived on time, timestamps are trusted for a limited time") {
  OdometryTimestampCheck dates(4ms);
  CHECK_FALSE(dates.admit(kBegin, kBegin + 10ms));
  CHECK(dates.admit(kBegin + 20ms, kBegin + 24ms));
  CHECK(dates.admit(kBegin + 30ms, kBegin + 50ms));
  CHECK_FALSE(dates.admit(kBegin + 30ms, kBegin + 51ms));
  CHECK(dates.admit(kBegin + 500ms, kBegin + 510ms));
  CHECK_FALSE(dates.admit(kBegin + 520ms, kBegin + 530ms));
}

TEST_CASE("after a report from the future, all reports are refused until a report arrives on time") {
  OdometryTimestampCheck dates(4ms);
  CHECK(dates.admit(kBegin, kBegin));
  CHECK(dates.admit(kBegin + 14ms, kBegin + 10ms));
  CHECK_FALSE(dates.admit(kBegin + 25ms, kBegin + 20ms));
  CHECK_FALSE(dates.admit(kBegin + 20ms, kBegin + 30ms));
  CHECK(dates.admit(kBegin + 40ms, kBegin + 40ms));
}

TEST_CASE("timestamps are never trusted if their offset exceeds the maximum error plus the delay") {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const Duration max_error = from_seconds(rng.uniform(0.001, 0.006));
    const Duration least_delay = from_seconds(rng.uniform(0, 0.003)),
                   jitter = from_seconds(rng.uniform(0, 0.005));
    const Duration behind = from_seconds(rng.uniform(0.001, 0.2));
    const bool is_ahead = rng.chance(0.5);
    // If the clock is ahead, the delay hides part of the offset.
    const Duration offset = is_ahead ? max_error + least_delay + jitter + behind : -max_error - behind;
    OdometryTimestampCheck dates(max_error);
    Time now = kBegin;
    for (int i = 0; i < 300; ++i) {
      now += 20ms;
      const Duration delay = least_delay + from_seconds(rng.uniform(0, to_seconds(jitter)));
      REQUIRE_FALSE(dates.admit(now + offset, now + delay));
    }
  }
}

}  // namespace sidestep::odometry_timestamp_check_test
