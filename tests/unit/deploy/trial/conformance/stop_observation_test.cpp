// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/stop_observation.hpp"

#include "tests/catch.hpp"

namespace sidestep::stop_observation_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr VersionNumber kLast = 7;

/// A version that stops from 0.3 m/s.
Version last_version() {
  Version version;
  version.number = kLast;
  version.trajectory = Trajectory(kBegin, {Vec2(0, 0), Vec2(0.3, 0)});
  append_stop(version.trajectory, 2.5);
  return version;
}

/// A robot that is seen every `period`, from `phase` after the beginning of its stop on.
struct SeenStop {
  explicit SeenStop(Duration period, Duration phase = 0ms) : period_(period), next_(kBegin + phase) {}

  void see_until(Time end) {
    for (; next_ <= end; next_ += period_) {
      const Trajectory& stop = observation.stop();
      const Vec2 seen_m = stop.state_at(next_).position_m + error_m;
      observation.add({next_, next_, seen_m, stop.motion_at(next_), executed, false});
    }
  }

  /// The time at which the observation is over, as a test that looks once per cycle finds it.
  Time see_all() {
    Time now = kBegin;
    for (; !observation.is_over(now); now += 16ms) see_until(now);
    return now;
  }

  StopObservation observation{last_version()};
  Vec2 error_m{0, 0};
  VersionNumber executed = kLast;

 private:
  Duration period_;
  Time next_;
};

TEST_CASE("a slow stop is judged at any rate and phase of the cameras") {
  const int rate_hz = GENERATE(5, 10, 30, 60, 100, 1000);
  const double phase = GENERATE(0.0, 0.2, 0.4, 0.6, 0.8, 0.99);
  const Duration period = from_seconds(1.0 / rate_hz);
  SeenStop stop(period, from_seconds(phase / rate_hz));
  const Time over = stop.see_all();
  CAPTURE(rate_hz, phase, stop.observation.why_not_judged().value_or(""));
  CHECK_FALSE(stop.observation.why_not_judged());
  CHECK(over >= stop.observation.stop().end() + 700ms);
  CHECK(over <= stop.observation.stop().end() + 700ms + 3 * period + 16ms);
  CHECK(stop.observation.overshoot_m() < 1e-9);
  CHECK(stop.observation.rest_error_m() < 1e-9);
}

TEST_CASE("the overshoot and the place of rest are measured beside the last version") {
  SeenStop stop(10ms);
  stop.error_m = {0.02, 0};
  stop.see_until(stop.observation.stop().end() + 200ms);
  stop.error_m = {-0.005, 0};
  (void)stop.see_all();
  CHECK_FALSE(stop.observation.why_not_judged());
  CHECK(stop.observation.overshoot_m() == Approx(0.02));
  CHECK(stop.observation.rest_error_m() == Approx(0.005));
}

TEST_CASE("a stop that vision does not see to its end is not judged, and vision is named as the cause") {
  SeenStop stop(10ms);
  stop.see_until(stop.observation.stop().end() + 300ms);
  CHECK_FALSE(stop.observation.is_over(kBegin + 2s));
  CHECK(stop.observation.is_over(kBegin + 5s));
  CHECK(stop.observation.why_not_judged().value_or("") ==
        "vision saw the robot 0 times in 3 s at rest, fewer than 3 times");
}

TEST_CASE("a stop that vision sees only at rest is not judged, because an overshoot may be missed") {
  SeenStop stop(10ms, 620ms);
  (void)stop.see_all();
  CHECK(stop.observation.why_not_judged().value_or("") ==
        "vision did not see the robot for 620 ms while it stopped");
}

TEST_CASE("a robot that was not given the last version is not blamed for resting elsewhere") {
  SeenStop stop(10ms);
  stop.executed = kLast - 1;
  stop.error_m = {-0.015, 0};
  (void)stop.see_all();
  CHECK(stop.observation.why_not_judged().value_or("") ==
        "the robot did not execute the last version, which arrived too late or not at all");
}

TEST_CASE("a robot that makes its own stop is judged, and its own stop is named") {
  SeenStop stop(10ms);
  stop.executed = kLast + (VersionNumber{1} << 20);
  (void)stop.see_all();
  CHECK_FALSE(stop.observation.why_not_judged());
  CHECK(stop.observation.has_own_stop());
}

}  // namespace sidestep::stop_observation_test
