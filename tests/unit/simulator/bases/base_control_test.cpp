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

}  // namespace sidestep::base_control_test
