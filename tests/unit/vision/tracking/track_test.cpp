// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/track.hpp"

#include <cmath>

#include "tests/catch.hpp"

namespace sidestep::track_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kPeriod{16'000'000};

Observation seen(Time at, const Vec2& position_m) { return {at, 0, position_m, 0}; }

/// The confirmed track of a resting robot, last observed at kBegin.
TrackState resting(const Vec2& position_m, const TrackModel& model) {
  TrackState state;
  for (int i = 40; i >= 0; --i) state = advanced(state, seen(kBegin - i * kPeriod, position_m), model);
  REQUIRE(state.is_confirmed);
  return state;
}

TEST_CASE("an observation within the gate belongs to the track, but one a millionth outside does not") {
  const TrackModel model;
  const Vec2 place_m(2, 1);
  const TrackState state = resting(place_m, model);
  ConstantVelocityFilter<2> predicted = state.filter.position;
  predicted.predict(to_seconds(kPeriod), model.motion, model.rolling_mps2);
  // The filter is equally uncertain in all directions, so its distance grows with the square of the offset.
  const double unit2 = predicted.squared_distance({1, 0}, model.position_noise_m * model.position_noise_m);
  const double gate_m = model.gate_sigma / std::sqrt(unit2);
  REQUIRE(gate_m < model.gate_m);
  const auto accepts = [&](double offset_m) {
    const Vec2 at_m = predicted.position() + Vec2(0, offset_m);
    return advanced(state, seen(kBegin + kPeriod, at_m), model).last.position_m == at_m;
  };
  CHECK(accepts(gate_m * (1 - 1e-6)));
  CHECK_FALSE(accepts(gate_m * (1 + 1e-6)));
}

TEST_CASE("the nearer of two observations away from a track becomes the track's candidate") {
  TrackModel model;
  model.displaced_hits = 100;
  const Vec2 place_m(2, 1), far_m(1, 1), near_m(2.5, 1);
  const TrackState state = resting(place_m, model);
  const TrackState one = advanced(state, seen(kBegin + kPeriod, far_m), model);
  REQUIRE(one.candidate.position.position() == far_m);
  const TrackState two = advanced(one, seen(kBegin + 2 * kPeriod, near_m), model);
  CHECK(two.candidate.position.position() == near_m);
  const TrackState three = advanced(two, seen(kBegin + 3 * kPeriod, far_m), model);
  CHECK(three.candidate.position.position() == near_m);
}

TEST_CASE("two observations move a displaced robot's track without averaging with older observations") {
  const TrackModel model;
  const Vec2 place_m(2, 1), displaced_m(2.05, 1);
  const TrackState state = resting(place_m, model);
  // Two more cameras whose images have the same capture time.
  TrackState moved = advanced(state, seen(kBegin, displaced_m), model);
  CHECK(moved.last.position_m == place_m);
  moved = advanced(moved, seen(kBegin, displaced_m), model);
  CHECK(moved.last.position_m == displaced_m);
}

TEST_CASE("an uncertain date makes a moving object's position uncertain, and no object at rest") {
  const TrackModel model;
  const auto variance_m2 = [&](double speed_mps, Duration date_uncertainty) {
    TrackState state;
    Time at = kBegin;
    for (int i = 0; i < 30; ++i, at += Duration{16'666'667}) {
      Observation observation = seen(at, {speed_mps * to_seconds(at - kBegin), 0});
      observation.date_uncertainty = date_uncertainty;
      state = advanced(state, observation, model);
    }
    const auto estimate = estimate_at(state, state.last.captured_at, model);
    REQUIRE(estimate);
    return estimate->position_variance_m2;
  };
  const Duration uncertainty{10'000'000};
  CHECK(variance_m2(2, uncertainty) >= variance_m2(2, Duration{0}) + 0.9 * 0.02 * 0.02);
  CHECK(variance_m2(0, uncertainty) < 1e-5);
}

}  // namespace sidestep::track_test
