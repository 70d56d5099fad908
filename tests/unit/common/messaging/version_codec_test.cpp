// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/version_codec.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/motion/random_trajectory.hpp"

namespace sidestep::version_codec_test {

TEST_CASE("a version survives encoding and decoding bit for bit") {
  Rng rng(1);
  for (int i = 0; i < 10'000; ++i) {
    const Version in{static_cast<RobotId>(rng.below(kMaxRobots)), rng.bits(), rng.bits(), rng.bits(),
                     random_trajectory(rng)};
    const auto out = decode(encode(in));
    REQUIRE(out);
    REQUIRE(out->robot == in.robot);
    REQUIRE(out->incarnation == in.incarnation);
    REQUIRE(out->number == in.number);
    REQUIRE(out->base == in.base);
    REQUIRE(out->trajectory.start() == in.trajectory.start());
    REQUIRE(out->trajectory.end() == in.trajectory.end());
    const Time t = in.trajectory.start() + from_seconds(rng.uniform(0, 1));
    REQUIRE(out->trajectory.state_at(t).position_m == in.trajectory.state_at(t).position_m);
    REQUIRE(out->trajectory.state_at(t).velocity_mps == in.trajectory.state_at(t).velocity_mps);
  }
}

TEST_CASE("a version that contains a non-finite or implausible number is refused") {
  Rng rng(2);
  Version version{1, 1, 1, 0, random_trajectory(rng)};
  const auto good = encode(version);
  REQUIRE(decode(good));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300}) {
    for (const auto set :
         {+[](msg::Version&m, double v) { m.x_m(v); }, +[](msg::Version&m, double v) { m.y_m(v); },
          +[](msg::Version&m, double v) { m.vx_mps(v); }, +[](msg::Version&m, double v) { m.vy_mps(v); },
          +[](msg::Version&m, double v) { m.inflation_m(v); },
          +[](msg::Version&m, double v) { m.phases()[0].ax_mps2(v); },
          +[](msg::Version&m, double v) { m.phases()[0].ay_mps2(v); }}) {
      auto corrupted = good;
      set(corrupted, bad);
      CHECK_FALSE(decode(corrupted));
    }
  }
  auto corrupted = good;
  corrupted.robot(kMaxRobots);
  CHECK_FALSE(decode(corrupted));
  corrupted = good;
  corrupted.phase_count(Trajectory::kMaxPhases + 1);
  CHECK_FALSE(decode(corrupted));
  corrupted = good;
  corrupted.inflation_m(-0.001);
  CHECK_FALSE(decode(corrupted));
  corrupted = good;
  corrupted.phases()[0].duration_ns(-1);
  CHECK_FALSE(decode(corrupted));
  corrupted = good;
  corrupted.start_ns(std::numeric_limits<std::int64_t>::min());
  CHECK_FALSE(decode(corrupted));
}

TEST_CASE("an intent survives encoding and decoding to single precision") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  Version in{1, 1, 1, 0, random_trajectory(rng)};
  REQUIRE(decode(encode(in)));
  CHECK_FALSE(decode(encode(in))->intent);
  const auto random_vector = [&](double max) {
    const double x = rng.uniform(-max, max);
    return Vec2(x, rng.uniform(-max, max));
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec2 velocity = random_vector(3), waypoint = random_vector(10), goal = random_vector(10);
    in.intent = Intent{velocity, rng.uniform(0, 2), waypoint, goal};
    const auto out = decode(encode(in));
    REQUIRE(out);
    REQUIRE(out->intent);
    REQUIRE((out->intent->velocity_mps - velocity).norm() < 1e-6);
    REQUIRE(out->intent->velocity_duration_s == Approx(in.intent->velocity_duration_s).margin(1e-6));
    REQUIRE((out->intent->waypoint_m - waypoint).norm() < 2e-6);
    REQUIRE((out->intent->goal_m - goal).norm() < 2e-6);
  }
}

TEST_CASE("a version with an implausible intent is refused") {
  Rng rng(4);
  Version version{1, 1, 1, 0, random_trajectory(rng)};
  version.intent = Intent{{1, 0}, 0.5, {1, 1}, {2, 2}};
  const auto good = encode(version);
  REQUIRE(decode(good));
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 1e30F}) {
    for (const auto set :
         {+[](msg::Intent&m, float v) { m.vx_mps(v); }, +[](msg::Intent&m, float v) { m.vy_mps(v); },
          +[](msg::Intent&m, float v) { m.velocity_duration_s(v); },
          +[](msg::Intent&m, float v) { m.via_x_m(v); }, +[](msg::Intent&m, float v) { m.via_y_m(v); },
          +[](msg::Intent&m, float v) { m.goal_x_m(v); }, +[](msg::Intent&m, float v) { m.goal_y_m(v); },
          +[](msg::Intent&m, float v) { m.target_x_m(v); },
          +[](msg::Intent&m, float v) { m.target_y_m(v); }}) {
      auto corrupted = good;
      set(corrupted.intent(), bad);
      CAPTURE(bad);
      CHECK_FALSE(decode(corrupted));
      // The intent is ignored if has_intent is false.
      corrupted.has_intent(false);
      CHECK(decode(corrupted));
    }
  }
  auto corrupted = good;
  corrupted.intent().velocity_duration_s(-0.1F);
  CHECK_FALSE(decode(corrupted));
}

}  // namespace sidestep::version_codec_test
