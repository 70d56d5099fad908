// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/packet_times.hpp"

#include "tests/catch.hpp"

namespace sidestep::packet_times_test {

using namespace std::chrono_literals;

constexpr FrameStamps kReal{1'700'000'000s, 1'700'000'000s + 35ms}, kSimulated{300ms, 320ms};

TEST_CASE("packets are dated by real time, or by simulated time from any origin") {
  FrameStamps times = packet_times({}, kReal, kSimulated);
  CHECK(times.captured == kReal.captured);
  CHECK(times.sent == kReal.sent);
  for (const Duration start : {Duration(0s), Duration(-1s), Duration(1'600'000'000s)}) {
    times = packet_times({.start = start}, kReal, kSimulated);
    CHECK(times.captured == start + 300ms);
    CHECK(times.sent == start + 320ms);
  }
}

TEST_CASE("wrong capture times are too late, but not later than the time of sending") {
  CHECK(packet_times({.capture_error = 25ms}, kReal, kSimulated).captured == kReal.captured + 25ms);
  CHECK(packet_times({.start = 0s, .capture_error = 25ms}, kReal, kSimulated).captured == 320ms);
}

}  // namespace sidestep::packet_times_test
