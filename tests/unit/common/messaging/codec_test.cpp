// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/codec.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/unit/common/motion/random_trajectory.hpp"

using namespace sidestep;

TEST_CASE("a version comes out of its message as it went in, to the last bit") {
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

TEST_CASE("a version with a number that is none, or beyond all bounds, is refused") {
  Rng rng(2);
  Version version{1, 1, 1, 0, random_trajectory(rng)};
  const auto good = encode(version);
  REQUIRE(decode(good));
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf, 1e300}) {
    for (const auto set :
         {+[](msg::Version&m, double v) { m.x_m(v); }, +[](msg::Version&m, double v) { m.y_m(v); },
          +[](msg::Version&m, double v) { m.vx_mps(v); }, +[](msg::Version&m, double v) { m.vy_mps(v); },
          +[](msg::Version&m, double v) { m.phases()[0].ax_mps2(v); },
          +[](msg::Version&m, double v) { m.phases()[0].ay_mps2(v); }}) {
      auto spoilt = good;
      set(spoilt, bad);
      CHECK_FALSE(decode(spoilt));
    }
  }
  auto spoilt = good;
  spoilt.robot(kMaxRobots);
  CHECK_FALSE(decode(spoilt));
  spoilt = good;
  spoilt.phase_count(Trajectory::kMaxPhases + 1);
  CHECK_FALSE(decode(spoilt));
  spoilt = good;
  spoilt.phases()[0].duration_ns(-1);
  CHECK_FALSE(decode(spoilt));
  spoilt = good;
  spoilt.start_ns(std::numeric_limits<std::int64_t>::min());
  CHECK_FALSE(decode(spoilt));
}

TEST_CASE("what a robot means to do comes out of its message as it went in, to single precision") {
  const std::uint64_t seed = 3;
  CAPTURE(seed);
  Rng rng(seed);
  Version in{1, 1, 1, 0, random_trajectory(rng)};
  REQUIRE(decode(encode(in)));
  CHECK_FALSE(decode(encode(in))->intent);
  const auto drawn = [&](double most) {
    const double x = rng.uniform(-most, most);
    return Vec2(x, rng.uniform(-most, most));
  };
  for (int i = 0; i < 1000; ++i) {
    const Vec2 velocity = drawn(3), waypoint = drawn(10), goal = drawn(10);
    in.intent = Intent{velocity, rng.uniform(0, 2), waypoint, goal};
    const auto out = decode(encode(in));
    REQUIRE(out);
    REQUIRE(out->intent);
    REQUIRE((out->intent->velocity_mps - velocity).norm() < 1e-6);
    REQUIRE(out->intent->hold_s == Approx(in.intent->hold_s).margin(1e-6));
    REQUIRE((out->intent->waypoint_m - waypoint).norm() < 2e-6);
    REQUIRE((out->intent->goal_m - goal).norm() < 2e-6);
  }
}

TEST_CASE("a version that means to do what makes no sense is refused") {
  Rng rng(4);
  Version version{1, 1, 1, 0, random_trajectory(rng)};
  version.intent = Intent{{1, 0}, 0.5, {1, 1}, {2, 2}};
  const auto good = encode(version);
  REQUIRE(decode(good));
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, inf, -inf, 1e30F}) {
    for (const auto set :
         {+[](msg::Intent&m, float v) { m.vx_mps(v); }, +[](msg::Intent&m, float v) { m.vy_mps(v); },
          +[](msg::Intent&m, float v) { m.hold_s(v); }, +[](msg::Intent&m, float v) { m.via_x_m(v); },
          +[](msg::Intent&m, float v) { m.via_y_m(v); }, +[](msg::Intent&m, float v) { m.goal_x_m(v); },
          +[](msg::Intent&m, float v) { m.goal_y_m(v); }}) {
      auto spoilt = good;
      set(spoilt.intended(), bad);
      CAPTURE(bad);
      CHECK_FALSE(decode(spoilt));
      // Nobody looks at what is not there.
      spoilt.has_intent(false);
      CHECK(decode(spoilt));
    }
  }
  auto spoilt = good;
  spoilt.intended().hold_s(-0.1F);
  CHECK_FALSE(decode(spoilt));
}
