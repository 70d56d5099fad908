// SPDX-License-Identifier: Apache-2.0
#include "simulator/body.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "common/random/rng.hpp"

namespace sidestep {
namespace {

// The differential equation in tiny steps.
State integrated(State state, Vec2& acceleration, const Vec2& wish, double lag_s) {
  const int parts = 2000;
  const double dt = kPhysicsStepSeconds / parts;
  for (int i = 0; i < parts; ++i) {
    const Vec2 next = acceleration + (wish - acceleration) * (dt / lag_s);
    state = state_after(state, 0.5 * (acceleration + next), dt);
    acceleration = next;
  }
  return state;
}

TEST_CASE("a body follows its wish with a first-order lag") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  const BodySettings settings;
  Body body({1, 2}, 0, settings);
  State reference{{1, 2}, {0, 0}};
  Vec2 acceleration(0, 0);
  Vec2 wish(0, 0);
  for (int step = 0; step < 300; ++step) {
    if (step % 20 == 0) wish = rotated(Vec2(rng.uniform(0, 5), 0), rng.uniform(-3, 3));
    body.step({wish, 0});
    reference = integrated(reference, acceleration, wish, settings.lag_s);
  }
  CHECK((body.position_m() - reference.position_m).norm() < 1e-6);
  CHECK((body.velocity_mps() - reference.velocity_mps).norm() < 1e-5);
}

TEST_CASE("a body accelerates no harder and goes no faster than its limits") {
  Rng rng(4);
  const BodySettings settings;
  Body body({0, 0}, 0, settings);
  for (int step = 0; step < 5000; ++step) {
    const double wildness = step % 3 == 0 ? 1e6 : 20;
    body.step({Vec2(rng.uniform(-0.2, 1) * wildness, rng.normal()), rng.uniform(-0.2, 1) * wildness});
    REQUIRE(body.acceleration_mps2().norm() <= settings.acceleration_mps2 * (1 + 1e-9));
    REQUIRE(body.velocity_mps().norm() <= settings.speed_mps * (1 + 1e-9));
    REQUIRE(std::abs(body.angular_radps()) <= settings.angular_speed_radps);
  }
  CHECK(body.velocity_mps().norm() > 2.4);
}

TEST_CASE("a wish that is not a number counts as none") {
  Body body({0, 0}, 0, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int step = 0; step < 10; ++step) body.step({Vec2(nan, std::numeric_limits<double>::infinity()), nan});
  CHECK(body.position_m().norm() == 0);
  CHECK(body.heading_rad() == 0);
}

}  // namespace
}  // namespace sidestep
