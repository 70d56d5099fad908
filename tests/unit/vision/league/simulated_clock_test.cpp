// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <vector>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "vision/league/sender_clock.hpp"

namespace sidestep::simulated_clock_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kStep{16'666'667};  // of simulated time
constexpr Duration kMinDelay = std::chrono::microseconds(200);

/// What became of the frames of a part of a run.
struct Errors {
  int frames = 0, usable = 0, beyond_uncertainty = 0;
  Duration sum{0};  ///< of usable frames
  Duration largest{0};
  double usable_share() const { return static_cast<double>(usable) / frames; }
  Duration mean() const { return sum / std::max(usable, 1); }
};

/// A simulator of another rate than real time that sends a frame for each step.
class SlowSimulator {
 public:
  SlowSimulator(std::uint64_t seed, Duration first_time) : rng_(seed), simulated_(first_time) {}

  SenderClock& clock() { return clock_; }
  void set_rate(double rate) { rate_ = rate; }
  void restart(Duration first_time) { simulated_ = first_time; }
  void wait(Duration duration) { now_ += duration; }
  /// Each step takes up to this much longer, but the rate stays the same on average.
  void set_stutter(Duration stutter) { stutter_ = stutter; }

  /// Runs for a local duration. Checks the limits of each date.
  Errors run(Duration duration) {
    Errors errors;
    for (const Time end = now_ + duration; now_ < end;) send_frame(errors);
    return errors;
  }

 private:
  void send_frame(Errors& errors) {
    // A capture is the time of its step, plus the unevenness of this step.
    now_ += from_seconds(to_seconds(kStep) / rate_);
    simulated_ += kStep;
    const Time captured = now_ + from_seconds(to_seconds(stutter_) * rng_.uniform());
    const double max_jitter_s = rng_.uniform(0, 0.003);
    const Duration late = rng_.chance(0.01) ? from_seconds(rng_.uniform(0, 0.03)) : Duration{0};
    last_arrival_ =
        std::max(last_arrival_, captured + kMinDelay + from_seconds(max_jitter_s * rng_.uniform()) + late);
    const auto dated = clock_.add(simulated_, simulated_, last_arrival_);
    ++errors.frames;
    if (!dated) return;
    REQUIRE(dated->captured_at <= last_arrival_);
    REQUIRE(dated->captured_at >= last_arrival_ - SenderClock::kMaxAge);
    REQUIRE(dated->uncertainty > Duration{0});
    if (dated->uncertainty > SenderClock::kMaxUncertainty) return;
    const Duration error = dated->captured_at - captured;
    ++errors.usable;
    errors.sum += error;
    errors.largest = std::max(errors.largest, Duration{std::chrono::abs(error)});
    if (std::chrono::abs(error) > dated->uncertainty) ++errors.beyond_uncertainty;
  }

  Rng rng_;
  double rate_ = 1;
  Duration stutter_{0};
  Duration simulated_;
  Time now_ = kBegin, last_arrival_ = kBegin;
  SenderClock clock_;
};

TEST_CASE("frames of a simulator of any rate are dated within their uncertainty") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  for (const double rate : {0.5, 0.66, 0.8, 0.9, 0.97, 0.98, 0.99, 0.995, 0.998, 1.0, 1.005, 1.01, 1.02}) {
    CAPTURE(seed, rate);
    SlowSimulator simulator(seed, -seconds(1));
    simulator.set_rate(rate);
    CHECK(simulator.run(seconds(3)).beyond_uncertainty == 0);
    const Errors errors = simulator.run(seconds(60));
    CHECK(errors.beyond_uncertainty == 0);
    CHECK(errors.usable_share() > 0.98);
    CHECK(errors.largest < milliseconds(20));
    CHECK(std::chrono::abs(errors.mean()) < std::chrono::microseconds(1'500));
    CHECK(simulator.clock().kind() != SenderClockKind::kArrival);
    CHECK(simulator.clock().rate() == Approx(rate).margin(0.012));
    CHECK(simulator.clock().jumps() == 0);
  }
}

TEST_CASE("a simulator that becomes slower or faster again is dated within the uncertainty") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u, 5u, 6u);
  CAPTURE(seed);
  Rng rng(seed + 100);
  SlowSimulator simulator(seed, Duration{0});
  Errors all;
  (void)simulator.run(seconds(2));
  for (int change = 0; change < 100; ++change) {
    simulator.set_rate(rng.uniform(0.5, 1.02));
    const Errors errors = simulator.run(from_seconds(rng.uniform(0.5, 5)));
    all.frames += errors.frames;
    all.usable += errors.usable;
    all.beyond_uncertainty += errors.beyond_uncertainty;
    all.sum += errors.sum;
  }
  // A frame that is late while the simulator becomes faster cannot be told from one that is on time.
  CHECK(all.beyond_uncertainty <= all.frames / 500);
  CHECK(all.usable_share() > 0.93);
  CHECK(std::chrono::abs(all.mean()) < milliseconds(2));
  CHECK(simulator.clock().kind() == SenderClockKind::kScaled);
}

TEST_CASE("a simulator that has run in real time is not dated early when it becomes slower") {
  SlowSimulator simulator(7, Duration{0});
  (void)simulator.run(seconds(20));
  REQUIRE(simulator.clock().kind() == SenderClockKind::kSteady);
  simulator.set_rate(0.66);
  const Errors change = simulator.run(seconds(1));
  CHECK(change.beyond_uncertainty == 0);
  CHECK(change.usable_share() > 0.5);
  CHECK(simulator.clock().kind() == SenderClockKind::kScaled);
  simulator.set_rate(1);
  (void)simulator.run(seconds(15));
  CHECK(simulator.clock().kind() == SenderClockKind::kSteady);
}

TEST_CASE("steps of uneven length are dated within the uncertainty") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  SlowSimulator simulator(seed, Duration{0});
  simulator.set_rate(0.9);
  simulator.set_stutter(milliseconds(12));
  (void)simulator.run(seconds(3));
  const Errors errors = simulator.run(seconds(30));
  CHECK(errors.beyond_uncertainty <= errors.frames / 500);
  CHECK(errors.usable_share() > 0.9);
}

TEST_CASE("a slow simulator that restarts at zero is dated again within two tenths of a second") {
  const bool is_at_once = GENERATE(false, true);
  CAPTURE(is_at_once);
  SlowSimulator simulator(8, Duration{0});
  simulator.set_rate(0.9);
  (void)simulator.run(seconds(10));
  for (int restart = 0; restart < 10; ++restart) {
    simulator.restart(-seconds(1));
    if (!is_at_once) simulator.wait(seconds(1));
    CHECK(simulator.run(milliseconds(200)).usable > 0);
    const Errors errors = simulator.run(seconds(5));
    CHECK(errors.beyond_uncertainty == 0);
    CHECK(errors.usable_share() > 0.98);
  }
}

TEST_CASE("frames with useless times are dated by their arrival, with a stated uncertainty") {
  // Times that stand still, and times that are drawn at random.
  const bool is_random = GENERATE(false, true);
  CAPTURE(is_random);
  Rng rng(9);
  SenderClock clock;
  const auto add = [&](Time arrival) {
    const Duration captured = is_random ? from_seconds(rng.uniform(0, 1e9)) : Duration{0};
    return clock.add(captured, captured, arrival);
  };
  Time now = kBegin;
  for (const Time end = now + seconds(5); now < end; now += kStep) (void)add(now);
  REQUIRE(clock.kind() == SenderClockKind::kArrival);
  for (const Time end = now + seconds(20); now < end; now += kStep) {
    const auto dated = add(now);
    REQUIRE(dated);
    REQUIRE(dated->captured_at == now);
    REQUIRE(dated->uncertainty == SenderClock::kArrivalUncertainty);
  }
  // After a pause of this process, a burst of old frames arrives.
  now += seconds(1);
  for (int i = 0; i < 60; ++i) REQUIRE_FALSE(add(now));
}

TEST_CASE("a sender is dated by its times again once they are useful") {
  SenderClock clock;
  Time now = kBegin;
  for (const Time end = now + seconds(5); now < end; now += kStep)
    (void)clock.add(seconds(1), seconds(1), now);
  REQUIRE(clock.kind() == SenderClockKind::kArrival);
  for (const Time end = now + seconds(10); now < end; now += kStep)
    (void)clock.add(now - kBegin, now - kBegin, now);
  CHECK(clock.kind() != SenderClockKind::kArrival);
}

}  // namespace sidestep::simulated_clock_test
