// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/base_control.hpp"

#include "tests/catch.hpp"

namespace sidestep::base_control_test {
namespace {

using namespace std::chrono_literals;

struct Base {
  explicit Base(const BaseSettings& base_settings) : settings(base_settings) {}
  void run(Duration duration, const std::optional<BaseVelocity>& velocity) {
    for (const Time end = now + duration; now < end; now += kPhysicsStep) {
      if (velocity && to_ns(now) % 10'000'000 == 0) control.command(*velocity, now);
      body.step(control.actuation(body, now));
      max_speed_mps = std::max(max_speed_mps, body.velocity_mps().norm());
    }
  }
  BaseSettings settings;
  Time now = time_from_ns(1'000'000'000'000);
  Body body{Vec2(0, 0), 0, body_settings(settings)};
  BaseControl control{settings};
  double max_speed_mps = 0;
};

}  // namespace

TEST_CASE("a base starts to move after its latency and brakes when commands stop") {
  BaseSettings settings;
  settings.latency = 80ms;
  Base base(settings);
  const BaseVelocity forward{{1, 0}, 0};
  base.run(79ms, forward);
  CHECK(base.body.velocity_mps().norm() == 0);
  base.run(10ms, forward);
  CHECK(base.body.velocity_mps().x() > 0.01);
  base.run(500ms, forward);
  CHECK(base.body.velocity_mps().x() == Approx(1).margin(0.01));
  // The last command takes effect after 80 ms and lasts for 100 ms.
  base.run(160ms, std::nullopt);
  CHECK(base.body.velocity_mps().x() == Approx(1).margin(0.01));
  base.run(400ms, std::nullopt);
  CHECK(base.body.velocity_mps().norm() < 0.01);
}

TEST_CASE("a base obeys velocities in its own or the world's frame, within its acceleration limits") {
  BaseSettings settings;
  settings.latency = 0ms;
  Base base(settings);
  base.run(1s, BaseVelocity{{0, 0}, 1.5707963});
  CHECK(base.body.heading_rad() == Approx(1.57).margin(0.05));
  base.run(1s, BaseVelocity{{2, 0}, 0});
  CHECK(base.body.velocity_mps().y() == Approx(2).margin(0.05));
  base.run(1s, BaseVelocity{{2, 0}, 0, true});
  CHECK(base.body.velocity_mps().x() == Approx(2).margin(0.05));
  const double from_x = base.body.position_m().x();
  base.run(1s, BaseVelocity{});
  // Braking from 2 m/s at 5.9 m/s^2 takes 0.34 m, plus the distance until the motors brake.
  CHECK(base.body.position_m().x() - from_x > 0.34);
  CHECK(base.body.position_m().x() - from_x < 0.42);
  CHECK(base.max_speed_mps < 2.1);
}

TEST_CASE("a base without commands coasts straight to rest over the given time, whatever its speed") {
  const auto [speed_mps, turn_radps] =
      GENERATE(table<double, double>({{0.4, 0.0}, {0.4, 3.0}, {1.9, 0.0}, {1.9, 1.0}, {3.5, 0.0}}));
  CAPTURE(speed_mps, turn_radps);
  BaseSettings settings;
  settings.latency = 0ms;
  settings.coast = 1200ms;
  Base base(settings);
  base.run(2s, BaseVelocity{{speed_mps, 0}, turn_radps});
  base.run(90ms, std::nullopt);  // the last command was given 10 ms before, and lasts for 100 ms
  const Vec2 velocity_mps = base.body.velocity_mps(), from_m = base.body.position_m();
  CHECK(velocity_mps.norm() == Approx(speed_mps).epsilon(0.02));
  // The body lags behind the target velocity by about 20 ms.
  constexpr double kLag_s = 0.02;
  base.run(600ms, std::nullopt);
  CHECK(base.body.velocity_mps().norm() == Approx(speed_mps * (0.5 + kLag_s / 1.2)).epsilon(0.02));
  CHECK(base.body.angular_radps() == Approx(turn_radps * (0.5 + kLag_s / 1.2)).margin(0.05));
  base.run(750ms, std::nullopt);
  CHECK(base.body.velocity_mps().norm() < 0.01);
  CHECK(std::abs(base.body.angular_radps()) < 0.01);
  // At an even deceleration, the mean speed is half of the first speed.
  const Vec2 coasted_m = base.body.position_m() - from_m;
  CHECK((coasted_m - velocity_mps * (0.5 * 1.2 + kLag_s)).norm() < 0.05 * coasted_m.norm());
}

TEST_CASE("a base that coasts obeys the next command") {
  BaseSettings settings;
  settings.latency = 0ms;
  settings.coast = 1200ms;
  Base base(settings);
  base.run(1s, BaseVelocity{{2, 0}, 0});
  base.run(500ms, std::nullopt);
  base.run(700ms, BaseVelocity{{-1, 0}, 0});
  CHECK(base.body.velocity_mps().x() == Approx(-1).margin(0.01));
  base.run(90ms, std::nullopt);
  const double from_x = base.body.position_m().x();
  base.run(1500ms, std::nullopt);
  CHECK(base.body.position_m().x() - from_x == Approx(-0.6).margin(0.05));
}

TEST_CASE("a base with a long silence timeout keeps its last velocity for that time") {
  BaseSettings settings;
  settings.latency = 0ms;
  settings.silence_timeout = 1s;
  Base base(settings);
  base.run(1s, BaseVelocity{{1.9, 0}, 0});
  const double from_x = base.body.position_m().x();
  base.run(990ms, std::nullopt);
  CHECK(base.body.velocity_mps().x() == Approx(1.9).margin(0.01));
  base.run(600ms, std::nullopt);
  CHECK(base.body.velocity_mps().norm() < 0.01);
  CHECK(base.body.position_m().x() - from_x == Approx(1.9 * 0.99 + 1.9 * 1.9 / (2 * 5.9)).margin(0.06));
}

TEST_CASE("drag slows a base in proportion to its speed, and its turning speed is limited") {
  BaseSettings settings;
  settings.latency = 0ms;
  settings.drag_per_s = 2;
  settings.max_turn_radps = 4;
  for (const double speed_mps : {1.0, 2.0}) {
    Base base(settings);
    base.run(2s, BaseVelocity{{speed_mps, 0}, 0});
    // At a constant velocity v, the control's acceleration (command - v) / 20 ms equals the drag 2 v.
    CHECK(base.body.velocity_mps().x() == Approx(speed_mps / 1.04).epsilon(0.002));
  }
  Base base(settings);
  base.run(1s, BaseVelocity{{0, 0}, 10});
  CHECK(base.body.angular_radps() == Approx(4));
  base.run(1s, BaseVelocity{{0, 0}, -3});
  CHECK(base.body.angular_radps() == Approx(-3).margin(0.01));
}

}  // namespace sidestep::base_control_test
