// SPDX-License-Identifier: Apache-2.0
#include "common/time/clock_recovery.hpp"

#include <limits>

#include "tests/catch.hpp"

namespace sidestep::clock_recovery_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// A process that hears messages of other processes. `now` is true time.
struct Scene {
  ClockRecovery recovery;
  Time now = kBegin;
  Duration own_ahead{0};   ///< relative to true time
  Duration host_ahead{0};  ///< relative to true time
  bool is_in_use = false;

  void hear(std::uint32_t reference, Duration ahead, Duration delay, int messages = 10) {
    for (int i = 0; i < messages; ++i) {
      recovery.on_message(reference, to_ns(now + ahead - delay - i % 3 * 1ms), now + own_ahead);
      now += 10ms;
    }
  }
  bool end_period() { return recovery.end_period(host_ahead - own_ahead, is_in_use); }
  /// Whether the process adopts the host's clock after this many periods with a reference.
  bool adopts(Duration reference_ahead, Duration delay = 1ms, int periods = ClockRecovery::kPeriods) {
    bool result = false;
    for (int i = 0; i < periods; ++i) {
      hear(1, reference_ahead, delay);
      result = end_period();
    }
    return result;
  }
};

TEST_CASE("a process adopts its host's clock if the host's clock agrees with others and its own does not") {
  const Duration wrong = GENERATE(Duration(-24h), Duration(-1h), Duration(-1s), Duration(-20ms),
                                  Duration(300ms), Duration(2s), Duration(24h));
  const Duration delay = GENERATE(Duration(100us), Duration(5ms));
  CAPTURE(to_seconds(wrong), to_seconds(delay));
  Scene scene;
  scene.own_ahead = wrong;
  CHECK_FALSE(scene.adopts(0s, delay, ClockRecovery::kPeriods - 1));
  CHECK(scene.adopts(0s, delay, 1));
}

TEST_CASE("a process keeps its clock if it is within the clock bound of other processes' clocks") {
  Scene scene;
  scene.recovery = ClockRecovery(100ms);
  scene.own_ahead = -90ms;
  CHECK_FALSE(scene.adopts(0s, 1ms, 20));
  scene.own_ahead = -120ms;
  CHECK(scene.adopts(0s));
}

TEST_CASE("a step of the host's clock changes nothing while another process agrees with this one") {
  const Duration step =
      GENERATE(Duration(-24h), Duration(-1s), Duration(-20ms), Duration(20ms), Duration(1s), Duration(24h));
  const Duration delay = GENERATE(Duration(100us), Duration(20ms), Duration(150ms));
  CAPTURE(to_seconds(step), to_seconds(delay));
  Scene scene;
  scene.host_ahead = step;
  CHECK_FALSE(scene.adopts(0s, delay, 20));
  // The clock is kept even if a second process, started after the step, agrees with the host.
  for (int i = 0; i < 20; ++i) {
    scene.hear(1, 0s, delay);
    scene.hear(2, step, delay);
    CHECK_FALSE(scene.end_period());
  }
}

TEST_CASE("a process keeps its clock if it is in use or its host's clock has not been set") {
  Scene scene;
  CHECK_FALSE(scene.adopts(1h, 1ms, 20));
  scene.own_ahead = -24h;
  scene.is_in_use = true;
  CHECK_FALSE(scene.adopts(0s, 1ms, 20));
}

TEST_CASE("a process keeps its clock if neither its own nor its host's clock agrees with others") {
  Scene scene;
  scene.own_ahead = -24h;
  scene.host_ahead = -12h;
  CHECK_FALSE(scene.adopts(0s, 1ms, 20));
}

TEST_CASE("absent references, too few messages and impossible stamps are not evidence") {
  Scene scene;
  scene.own_ahead = -24h;
  for (int i = 0; i < 20; ++i) {
    scene.hear(1, 0s, 1ms, ClockRecovery::kMinMessages - 1);
    for (const std::int64_t stamp_ns : {std::int64_t{-1}, std::numeric_limits<std::int64_t>::min(),
                                        std::numeric_limits<std::int64_t>::max(), to_ns(kMaxTime) + 1}) {
      for (int k = 0; k < 10; ++k) scene.recovery.on_message(2, stamp_ns, scene.now);
    }
    CHECK_FALSE(scene.end_period());
  }
}

TEST_CASE("evidence is collected afresh when the host's clock is set again or a period lacks evidence") {
  Scene scene;
  scene.own_ahead = -24h;
  scene.host_ahead = 100ms;
  CHECK_FALSE(scene.adopts(100ms, 1ms, ClockRecovery::kPeriods - 1));
  scene.host_ahead = 0s;
  CHECK_FALSE(scene.adopts(0s, 1ms, ClockRecovery::kPeriods - 1));
  CHECK_FALSE(scene.end_period());
  CHECK_FALSE(scene.adopts(0s, 1ms, ClockRecovery::kPeriods - 1));
  CHECK(scene.adopts(0s, 1ms, 1));
}

TEST_CASE("messages with made-up references do not exhaust memory or make a process adopt another clock") {
  Scene scene;
  scene.host_ahead = 1h;
  for (int period = 0; period < 5; ++period) {
    scene.hear(0, 0s, 1ms);
    for (std::uint32_t id = 1; id < 5000; ++id) {
      for (int i = 0; i < 3; ++i) scene.recovery.on_message(id, to_ns(scene.now + 1h), scene.now);
    }
    CHECK_FALSE(scene.end_period());
  }
}

}  // namespace sidestep::clock_recovery_test
