// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_clock.hpp"

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::sender_clock_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{8'333'333};  // period of the frames of two cameras at 60 Hz
constexpr Duration kProcessing = milliseconds(9);
constexpr Duration kMinDelay = std::chrono::microseconds(200);

/// A sender whose clock shows `zero` at kBegin and drifts at a constant rate.
struct ClockModel {
  Duration zero;
  double drift = 0;
  Duration at(Time t) const { return zero + (t - kBegin) + from_seconds(drift * to_seconds(t - kBegin)); }
};

/// Sends consecutive frames through a network with random delays.
class Scene {
 public:
  Scene(const ClockModel& model, std::uint64_t seed) : model_(model), rng_(seed) {}

  ClockModel& model() { return model_; }
  Time now() const { return now_; }
  SenderClock& clock() { return clock_; }

  /// Sends the next frame, captured now, with an additional delay. Returns the error of its capture time;
  /// nullopt if there is no capture time.
  std::optional<Duration> frame(Duration additional_delay = Duration{0}) {
    const Time captured = now_, sent = captured + kProcessing;
    now_ += kFrame;
    const double max_jitter_s = rng_.uniform(0, 0.003);
    const Duration delay = kMinDelay + from_seconds(max_jitter_s * rng_.uniform()) + additional_delay;
    const auto captured_at = clock_.add(model_.at(captured), model_.at(sent), sent + delay);
    return captured_at ? std::optional(captured_at->captured_at - captured) : std::nullopt;
  }
  /// Sends frames for the settling time.
  void settle() {
    for (const Time end = now_ + SenderClock::kSettlingTime; now_ <= end;) (void)frame();
  }
  /// Sends frames for a duration. Each capture time must be within the bound.
  void run(Duration duration, Duration bound) {
    for (const Time end = now_ + duration; now_ < end;) {
      const auto error = frame();
      REQUIRE(error);
      REQUIRE(std::chrono::abs(*error) <= bound);
    }
  }
  /// Sends frames until one gets a capture time. Returns the number of frames before it, at most `max_count`.
  int frames_until_synchronised(int max_count) {
    for (int i = 0; i < max_count; ++i) {
      if (frame()) return i;
    }
    return max_count;
  }
  void wait(Duration duration) { now_ += duration; }

 private:
  ClockModel model_;
  Rng rng_;
  Time now_ = kBegin + seconds(1);
  SenderClock clock_;
};

/// Readings at kBegin of a clock that starts at 0, a correct clock, and a clock that is off by days.
const Duration kZeros[] = {Duration{0}, kBegin.time_since_epoch(),
                           kBegin.time_since_epoch() - std::chrono::hours(50)};

TEST_CASE("capture times become accurate to 0.9 ms for any origin and drift of the sender's clock") {
  for (const Duration zero : kZeros) {
    for (const double drift : {-2e-4, 0.0, 2e-4}) {
      CAPTURE(zero.count(), drift);
      Scene scene({zero, drift}, 11);
      scene.settle();
      scene.run(seconds(1), milliseconds(4));
      scene.run(seconds(20), std::chrono::microseconds(900));
      CHECK(scene.clock().jumps() == 0);
    }
  }
}

TEST_CASE("delayed frames get their time of capture, not of arrival") {
  Scene scene({Duration{0}}, 12);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  for (int i = 0; i < 600; ++i) {
    // Only every tenth frame is on time.
    const auto error = scene.frame(i % 10 == 0 ? Duration{0} : milliseconds(30 + i % 300));
    REQUIRE(error);
    REQUIRE(std::chrono::abs(*error) < std::chrono::microseconds(1'500));
  }
  CHECK_FALSE(scene.frame(milliseconds(501)));
  scene.run(seconds(1), std::chrono::microseconds(900));
  CHECK(scene.clock().jumps() == 0);
}

TEST_CASE("a process that was suspended never mistakes old frames for new ones") {
  const int pause_ms = GENERATE(100, 400, 700, 2'000, 20'000);
  CAPTURE(pause_ms);
  Scene scene({Duration{0}}, 13);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  // All frames that arrived during the suspension are received at the same time.
  const Time resumed = scene.now() + milliseconds(pause_ms);
  while (scene.now() + kProcessing + kMinDelay < resumed) {
    const auto error = scene.frame(resumed - (scene.now() + kProcessing + kMinDelay));
    if (error) REQUIRE(std::chrono::abs(*error) < milliseconds(1));
  }
  scene.run(seconds(5), std::chrono::microseconds(900));
  CHECK(scene.clock().jumps() == 0);
}

TEST_CASE("old frames of a new sender are not mistaken for new ones") {
  const int pause_ms = GENERATE(50, 300, 2'000);
  CAPTURE(pause_ms);
  Scene scene({Duration{0}}, 18);
  // The first frames are received together when the process resumes. Later frames are on time.
  const Time resumed = scene.now() + milliseconds(pause_ms);
  while (scene.now() + kProcessing + kMinDelay < resumed) {
    REQUIRE_FALSE(scene.frame(resumed - (scene.now() + kProcessing + kMinDelay)));
  }
  scene.settle();
  scene.run(seconds(1), milliseconds(4));
  CHECK(scene.clock().jumps() <= 1);
}

TEST_CASE("a clock that is set forward is accepted after five frames") {
  Scene scene({Duration{0}}, 14);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero += seconds(100);
  CHECK(scene.frames_until_synchronised(100) == 4);
  CHECK(scene.clock().jumps() == 1);
  scene.run(seconds(5), milliseconds(4));
}

TEST_CASE("a clock that is set back is accepted after a second") {
  const Duration back = GENERATE(Duration{milliseconds(600)}, Duration{std::chrono::hours(1000)});
  CAPTURE(back.count());
  Scene scene({kBegin.time_since_epoch()}, 15);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero -= back;
  const Time set_at = scene.now();
  (void)scene.frames_until_synchronised(1000);
  CHECK(scene.now() - set_at > milliseconds(990));
  CHECK(scene.now() - set_at < milliseconds(1'050));
  CHECK(scene.clock().jumps() == 1);
  scene.run(seconds(5), milliseconds(4));
}

TEST_CASE("a small step of the clock is corrected after two seconds") {
  const Duration step = GENERATE(Duration{milliseconds(-300)}, Duration{milliseconds(30)});
  CAPTURE(step.count());
  Scene scene({Duration{0}}, 16);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero += step;
  scene.run(milliseconds(2'300), std::chrono::abs(step) + milliseconds(4));
  scene.run(seconds(2), milliseconds(1));
}

TEST_CASE("a simulation that restarts at zero after a silence is accepted") {
  Scene scene({Duration{0}}, 17);
  scene.settle();
  scene.run(seconds(10), milliseconds(4));
  scene.wait(seconds(5));
  scene.model().zero = -(scene.now() - kBegin);
  (void)scene.frames_until_synchronised(1000);
  scene.run(seconds(3), milliseconds(4));
}

TEST_CASE("single frames with absurd timestamps change nothing") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Scene scene({kBegin.time_since_epoch()}, seed);
  scene.settle();
  Rng rng(seed);
  scene.run(seconds(3), milliseconds(4));
  for (int i = 0; i < 2000; ++i) {
    if (rng.chance(0.2)) {
      const Duration absurd = from_seconds(rng.chance(0.5) ? rng.uniform(0, 8.5e9) : rng.uniform(0, 1e6));
      const auto captured_at = scene.clock().add(absurd, absurd + milliseconds(3), scene.now());
      if (captured_at) REQUIRE(std::chrono::abs(captured_at->captured_at - scene.now()) < milliseconds(600));
    } else {
      const auto error = scene.frame();
      REQUIRE(error);
      REQUIRE(std::chrono::abs(*error) < milliseconds(1));
    }
  }
}

TEST_CASE("a send time from another clock is ignored") {
  const Duration sent = GENERATE(Duration{0}, kBegin.time_since_epoch(), Duration{milliseconds(4'400)});
  CAPTURE(sent.count());
  SenderClock clock;
  for (int i = 0; i < 100; ++i) {
    const Time arrival = kBegin + kFrame * i;
    const auto captured_at = clock.add(seconds(5) + kFrame * i, sent, arrival);
    REQUIRE(captured_at.has_value() == (arrival >= kBegin + SenderClock::kSettlingTime));
    if (captured_at) CHECK(captured_at->captured_at == arrival);
  }
}

}  // namespace sidestep::sender_clock_test
