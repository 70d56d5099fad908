// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::body_test {

// Integrates the differential equation in tiny steps.
State integrated(State state, Vec2& acceleration, const Vec2& desired, double lag_s) {
  const int parts = 2000;
  const double dt = kPhysicsStepSeconds / parts;
  for (int i = 0; i < parts; ++i) {
    const Vec2 next = acceleration + (desired - acceleration) * (dt / lag_s);
    state = state_after(state, 0.5 * (acceleration + next), dt);
    acceleration = next;
  }
  return state;
}

TEST_CASE("a body follows the command with a first-order lag") {
  const std::uint64_t seed = GENERATE(1, 2, 3);
  CAPTURE(seed);
  Rng rng(seed);
  const BodySettings settings;
  Body body({1, 2}, 0, settings);
  State reference{{1, 2}, {0, 0}};
  Vec2 acceleration(0, 0);
  Vec2 desired(0, 0);
  for (int step = 0; step < 300; ++step) {
    if (step % 20 == 0) {
      const double angle_rad = rng.uniform(-3, 3);
      desired = rotated(Vec2(rng.uniform(0, 5), 0), angle_rad);
    }
    body.step({desired, 0});
    reference = integrated(reference, acceleration, desired, settings.lag_s);
  }
  CHECK((body.position_m() - reference.position_m).norm() < 1e-6);
  CHECK((body.velocity_mps() - reference.velocity_mps).norm() < 1e-5);
}

TEST_CASE("a body obeys its acceleration and speed limits") {
  Rng rng(4);
  const BodySettings settings;
  Body body({0, 0}, 0, settings);
  for (int step = 0; step < 5000; ++step) {
    const double wildness = step % 3 == 0 ? 1e6 : 20;
    const double y = rng.normal(), x = rng.uniform(-0.2, 1) * wildness;
    body.step({Vec2(x, y), rng.uniform(-0.2, 1) * wildness});
    REQUIRE(body.acceleration_mps2().norm() <= settings.acceleration_mps2 * (1 + 1e-9));
    REQUIRE(body.velocity_mps().norm() <= settings.speed_mps * (1 + 1e-9));
    REQUIRE(std::abs(body.angular_radps()) <= settings.angular_speed_radps);
  }
  CHECK(body.velocity_mps().norm() > 2.4);
}

TEST_CASE("a command that is not finite counts as zero") {
  Body body({0, 0}, 0, {});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int step = 0; step < 10; ++step) body.step({Vec2(nan, std::numeric_limits<double>::infinity()), nan});
  CHECK(body.position_m().norm() == 0);
  CHECK(body.heading_rad() == 0);
}

// Reads the odometry of the wheels.
struct Wheels {
  explicit Wheels(const Body& of) : body(of), last(of.rolled_position_m()) {}
  /// The mean velocity since the last call.
  Vec2 velocity() {
    const Vec2 moved = body.rolled_position_m() - last;
    last = body.rolled_position_m();
    return moved / kPhysicsStepSeconds;
  }
  const Body& body;
  Vec2 last;
};

TEST_CASE("a pushed body slides until friction has stopped it, and its wheels do not measure the slide") {
  const double push_mps = GENERATE(0.1, 0.3, 1.0);
  CAPTURE(push_mps);
  const BodySettings settings;
  Body body({0, 0}, 0, settings);
  for (int i = 0; i < 300; ++i) body.step({{i < 200 ? 3.0 : 0.0, 0}, 0});
  const Vec2 before = body.velocity_mps();
  Wheels wheels(body);
  Vec2 rolled = body.position_m();
  body.push({0, push_mps});
  CHECK(body.velocity_mps().y() == Approx(push_mps));
  for (int i = 0; i < 500; ++i) {
    body.step({});
    const Vec2 seen = wheels.velocity();
    REQUIRE((seen - before).norm() < 0.01);
    rolled += seen * kPhysicsStepSeconds;
  }
  const double slid_m = push_mps * push_mps / (2 * settings.friction_mps2);
  CHECK(body.position_m().y() == Approx(slid_m).epsilon(0.02));
  CHECK((body.velocity_mps() - before).norm() < 0.01);
  CHECK((rolled - Vec2(body.position_m().x(), 0)).norm() < 1e-9);
}

TEST_CASE("without grip, a body keeps its velocity regardless of its wheels") {
  Body body({0, 0}, 0, {});
  for (int i = 0; i < 300; ++i) body.step({{i < 200 ? 3.0 : 0.0, 0}, 0});
  const Vec2 start = body.position_m(), velocity = body.velocity_mps();
  Wheels wheels(body);
  body.set_grip(0);
  Vec2 seen;
  for (int i = 0; i < 100; ++i) {
    body.step({{-5, 0}, 0});
    seen = wheels.velocity();
  }
  CHECK((body.position_m() - start - 0.1 * velocity).norm() < 1e-9);
  CHECK(seen.x() < velocity.x() - 0.35);
  body.set_grip(1);
  for (int i = 0; i < 300; ++i) {
    body.step({});
    seen = wheels.velocity();
  }
  CHECK((seen - body.velocity_mps()).norm() < 1e-9);
}

TEST_CASE("with reduced grip, a body gains that fraction of the acceleration") {
  const double grip = GENERATE(0.2, 0.7);
  CAPTURE(grip);
  const BodySettings settings;
  Body body({0, 0}, 0, settings);
  body.set_grip(grip);
  Wheels wheels(body);
  Vec2 seen;
  for (int i = 0; i < 200; ++i) {
    body.step({{2, 0}, 0});
    seen = wheels.velocity();
  }
  // The wheels accelerate as usual. The body gains its fraction of this acceleration, and of the friction
  // with wheels that spin faster.
  const double spun = 2 * (0.2 - settings.lag_s);
  const double max = grip * (2 + settings.friction_mps2) * 0.2;
  CHECK(seen.x() == Approx(spun).margin(0.01));
  CHECK(body.velocity_mps().x() <= std::min(spun, max) + 0.01);
  CHECK(body.velocity_mps().x() >= grip * spun - 0.01);
}

TEST_CASE("a blocked wheel stops motion in one direction, and the wheels measure the stop") {
  const double heading = 0.7, blocked = GENERATE(0.0, 1.2);
  CAPTURE(blocked);
  Body body({0, 0}, heading, {});
  const Vec2 along = rotated(Vec2(1, 0), heading + blocked), across = left_of(along);
  for (int i = 0; i < 300; ++i) {
    body.step({i < 200 ? Vec2(2 * along + 2 * across) : Vec2(0, 0), 0});
  }
  const double before = body.velocity_mps().dot(across);
  Wheels wheels(body);
  body.set_blocked_wheel(blocked);
  body.step({});
  CHECK(std::abs(wheels.velocity().dot(along)) < 1e-9);
  for (int i = 0; i < 300; ++i) body.step({});
  wheels.velocity();
  body.step({});
  CHECK(std::abs(body.velocity_mps().dot(along)) < 1e-9);
  CHECK(body.velocity_mps().dot(across) == Approx(before).epsilon(0.02));
  body.set_blocked_wheel(std::nullopt);
  body.step({4 * along, 0});
  CHECK(body.velocity_mps().dot(along) > 0);
}

TEST_CASE("a body off the floor does not move, and returns at rest") {
  Body body({0, 0}, 0, {});
  for (int i = 0; i < 300; ++i) body.step({{3, 0}, 0});
  body.lift();
  const Vec2 there = body.position_m();
  for (int i = 0; i < 100; ++i) body.step({{3, 0}, 1});
  CHECK(body.position_m() == there);
  CHECK_FALSE(body.is_on_floor());
  body.put_down({1, 2}, 0.5);
  CHECK(body.is_on_floor());
  body.step({});
  CHECK(body.position_m() == Vec2(1, 2));
  CHECK(body.velocity_mps() == Vec2(0, 0));
}

}  // namespace sidestep::body_test
