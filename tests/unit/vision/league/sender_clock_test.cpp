// SPDX-License-Identifier: Apache-2.0
#include "vision/league/sender_clock.hpp"

#include <catch2/catch.hpp>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr Duration kFrame{8'333'333};  // two cameras at 60 Hz
constexpr Duration kProcessing = milliseconds(9);
constexpr Duration kLeastDelay = std::chrono::microseconds(200);

/// A sender whose clock shows `zero` at kBegin and drifts.
struct SenderModel {
  Duration zero;
  double drift = 0;
  Duration at(Time t) const { return zero + (t - kBegin) + from_seconds(drift * to_seconds(t - kBegin)); }
};

/// Sends frames, one after the other, through a network with random delays.
class Scene {
 public:
  Scene(const SenderModel& model, std::uint64_t seed) : model_(model), rng_(seed) {}

  SenderModel& model() { return model_; }
  Time now() const { return now_; }
  SenderClock& clock() { return clock_; }

  /// The next frame, captured now and delayed by so much more; how far it is dated from its true capture, or
  /// nothing.
  std::optional<Duration> frame(Duration more_delay = Duration{0}) {
    const Time captured = now_, sent = captured + kProcessing;
    now_ += kFrame;
    const Duration delay = kLeastDelay + from_seconds(rng_.uniform(0, 0.003) * rng_.uniform()) + more_delay;
    const auto dated = clock_.add(model_.at(captured), model_.at(sent), sent + delay);
    return dated ? std::optional(*dated - captured) : std::nullopt;
  }
  /// Frames until they are dated.
  void settle() {
    for (const Time end = now_ + SenderClock::kSettling; now_ <= end;) (void)frame();
  }
  /// Frames for so long, each dated within the bound.
  void run(Duration duration, Duration bound) {
    for (const Time end = now_ + duration; now_ < end;) {
      const auto error = frame();
      REQUIRE(error);
      REQUIRE(std::chrono::abs(*error) <= bound);
    }
  }
  /// Frames until one is dated, at most so many; how many were not.
  int until_dated(int most) {
    for (int i = 0; i < most; ++i) {
      if (frame()) return i;
    }
    return most;
  }
  void wait(Duration duration) { now_ += duration; }

 private:
  SenderModel model_;
  Rng rng_;
  Time now_ = kBegin + seconds(1);
  SenderClock clock_;
};

/// Simulated seconds from 0, the right time, and a clock that is days off.
const Duration kZeros[] = {Duration{0}, kBegin.time_since_epoch(),
                           kBegin.time_since_epoch() - std::chrono::hours(50)};

}  // namespace

TEST_CASE(
    "wherever a sender's clock has its zero frames are dated to within the least delay and some drift") {
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

TEST_CASE("delayed frames are dated when they were captured not when they came") {
  Scene scene({Duration{0}}, 12);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  for (int i = 0; i < 600; ++i) {
    // All but every tenth frame are late.
    const auto error = scene.frame(i % 10 == 0 ? Duration{0} : milliseconds(30 + i % 300));
    REQUIRE(error);
    REQUIRE(std::chrono::abs(*error) < std::chrono::microseconds(1'500));
  }
  CHECK_FALSE(scene.frame(milliseconds(501)));
  scene.run(seconds(1), std::chrono::microseconds(900));
  CHECK(scene.clock().jumps() == 0);
}

TEST_CASE("a process that was held up never takes old frames for new ones") {
  const int pause_ms = GENERATE(100, 400, 700, 2'000, 20'000);
  CAPTURE(pause_ms);
  Scene scene({Duration{0}}, 13);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  // What has come meanwhile is found all at once.
  const Time resumed = scene.now() + milliseconds(pause_ms);
  while (scene.now() + kProcessing + kLeastDelay < resumed) {
    const auto error = scene.frame(resumed - (scene.now() + kProcessing + kLeastDelay));
    if (error) REQUIRE(std::chrono::abs(*error) < milliseconds(1));
  }
  scene.run(seconds(5), std::chrono::microseconds(900));
  CHECK(scene.clock().jumps() == 0);
}

TEST_CASE("old frames of a sender that was never heard before are not taken for new ones") {
  const int pause_ms = GENERATE(50, 300, 2'000);
  CAPTURE(pause_ms);
  Scene scene({Duration{0}}, 18);
  // All that a process finds when it may go on again, and what comes then.
  const Time resumed = scene.now() + milliseconds(pause_ms);
  while (scene.now() + kProcessing + kLeastDelay < resumed) {
    REQUIRE_FALSE(scene.frame(resumed - (scene.now() + kProcessing + kLeastDelay)));
  }
  scene.settle();
  scene.run(seconds(1), milliseconds(4));
  CHECK(scene.clock().jumps() <= 1);
}

TEST_CASE("a clock that is set ahead is followed after five frames") {
  Scene scene({Duration{0}}, 14);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero += seconds(100);
  CHECK(scene.until_dated(100) == 4);
  CHECK(scene.clock().jumps() == 1);
  scene.run(seconds(5), milliseconds(4));
}

TEST_CASE("a clock that is set back is followed after a second") {
  const Duration back = GENERATE(Duration{milliseconds(600)}, Duration{std::chrono::hours(1000)});
  CAPTURE(back.count());
  Scene scene({kBegin.time_since_epoch()}, 15);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero -= back;
  const Time set_at = scene.now();
  (void)scene.until_dated(1000);
  CHECK(scene.now() - set_at > milliseconds(990));
  CHECK(scene.now() - set_at < milliseconds(1'050));
  CHECK(scene.clock().jumps() == 1);
  scene.run(seconds(5), milliseconds(4));
}

TEST_CASE("a small step of the clock is forgotten after two seconds") {
  const Duration step = GENERATE(Duration{milliseconds(-300)}, Duration{milliseconds(30)});
  CAPTURE(step.count());
  Scene scene({Duration{0}}, 16);
  scene.settle();
  scene.run(seconds(3), milliseconds(4));
  scene.model().zero += step;
  scene.run(milliseconds(2'300), std::chrono::abs(step) + milliseconds(4));
  scene.run(seconds(2), milliseconds(1));
}

TEST_CASE("a simulation that begins again at zero after a silence is followed") {
  Scene scene({Duration{0}}, 17);
  scene.settle();
  scene.run(seconds(10), milliseconds(4));
  scene.wait(seconds(5));
  scene.model().zero = -(scene.now() - kBegin);
  (void)scene.until_dated(1000);
  scene.run(seconds(3), milliseconds(4));
}

TEST_CASE("single frames with absurd stamps change nothing") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Scene scene({kBegin.time_since_epoch()}, seed);
  scene.settle();
  Rng rng(seed);
  scene.run(seconds(3), milliseconds(4));
  for (int i = 0; i < 2000; ++i) {
    if (rng.chance(0.2)) {
      const Duration absurd = from_seconds(rng.chance(0.5) ? rng.uniform(0, 8.5e9) : rng.uniform(0, 1e6));
      const auto dated = scene.clock().add(absurd, absurd + milliseconds(3), scene.now());
      if (dated) REQUIRE(std::chrono::abs(*dated - scene.now()) < milliseconds(600));
    } else {
      const auto error = scene.frame();
      REQUIRE(error);
      REQUIRE(std::chrono::abs(*error) < milliseconds(1));
    }
  }
}

TEST_CASE("where the time of sending is of another clock the time of capture alone is used") {
  const Duration sent = GENERATE(Duration{0}, kBegin.time_since_epoch(), Duration{milliseconds(4'400)});
  CAPTURE(sent.count());
  SenderClock clock;
  for (int i = 0; i < 100; ++i) {
    const Time arrival = kBegin + kFrame * i;
    const auto dated = clock.add(seconds(5) + kFrame * i, sent, arrival);
    REQUIRE(dated.has_value() == (arrival >= kBegin + SenderClock::kSettling));
    if (dated) CHECK(*dated == arrival);
  }
}

}  // namespace sidestep
