// SPDX-License-Identifier: Apache-2.0
#include "common/motion/robot_model.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::robot_model_test {

const MotionLimits kLimits;

TEST_CASE("A(v) reaches F ahead and sideways and D behind") {
  const Vec2 v(1, 0);
  CHECK(is_admissible({3, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({3.01, 0}, v, kLimits));
  CHECK(is_admissible({0, -3}, v, kLimits));
  CHECK_FALSE(is_admissible({0, 3.01}, v, kLimits));
  CHECK(is_admissible({-5, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({-5.01, 0}, v, kLimits));
  CHECK_FALSE(is_admissible({-4.5, 2}, v, kLimits));
  CHECK_FALSE(is_admissible({-3.01, 0}, {0, 0}, kLimits));
}

TEST_CASE("samples lie in A(v) and fill A(v), and limited accelerations respect the speed limit") {
  Rng rng(1);
  const Duration cycle{16'666'667};
  double furthest_behind = 0, furthest_ahead = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vec2 v = random_velocity(rng, kLimits.speed_mps, 3.2);
    const Vec2 a = sample_acceleration(v, kLimits, rng);
    REQUIRE(is_admissible(a, v, kLimits));
    furthest_ahead = std::max(furthest_ahead, a.dot(v.normalized()));
    furthest_behind = std::min(furthest_behind, a.dot(v.normalized()));
    const Vec2 b = limit_acceleration(random_vector(rng, 20), v, kLimits, cycle);
    REQUIRE(is_admissible(b, v, kLimits));
    REQUIRE(stays_admissible(b, v, kLimits, cycle));
    REQUIRE((v + to_seconds(cycle) * b).norm() <= kLimits.speed_mps + 1e-9);
  }
  CHECK(furthest_ahead > 2.95);
  CHECK(furthest_behind < -4.9);
}

TEST_CASE("an acceleration may be held if and only if it is admissible throughout") {
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(seed);
  Rng rng(seed);
  int held = 0, refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec2 v = random_velocity(rng, kLimits.speed_mps, 3.2);
    const Duration duration = from_seconds(rng.uniform(0.001, 0.4));
    Vec2 a = random_vector(rng, 5.2);
    const bool is_limited = rng.chance(0.3), is_straight = rng.chance(0.3);
    if (is_straight) a = rng.uniform(-5.2, 5.2) * v.normalized();
    if (is_limited) a = limit_acceleration(a, v, kLimits, duration);
    bool is_admissible_throughout = true;
    constexpr int kSteps = 400;
    for (int step = 0; step <= kSteps; ++step) {
      const Vec2 then = v + to_seconds(duration) * step / kSteps * a;
      // At rest there is no direction, and in the last instant before rest the robot still brakes.
      if (then.norm() > 1e-6) is_admissible_throughout &= is_admissible(a, then, kLimits);
    }
    const bool may = stays_admissible(a, v, kLimits, duration);
    CAPTURE(i, a, v, duration.count());
    REQUIRE(may == is_admissible_throughout);
    if (is_limited) REQUIRE(may);
    ++(may ? held : refused);
  }
  CHECK(held > 2000);
  CHECK(refused > 2000);
}

}  // namespace sidestep::robot_model_test
