// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/observation_codec.hpp"

#include "common/messaging/version_codec.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::observation_codec_test {

constexpr Time kNow = time_from_ns(1'000'000'000'000);

/// The observation as the receiver of a notice reads it.
std::optional<RobotObservation> sent(const RobotObservation& observation) {
  msg::RobotNotice notice;
  encode(observation, notice);
  return decode(notice, kNow);
}

TEST_CASE("the place of a displaced robot is sent unchanged while its speed is possible") {
  const RobotObservation seen{7, kNow, {1.5, -2}, {3, -4}, 0.25};
  const auto received = sent(seen);
  REQUIRE(received);
  CHECK(received->robot == 7);
  CHECK(received->observed_at == kNow);
  CHECK(received->position_m == seen.position_m);
  CHECK(received->velocity_mps == seen.velocity_mps);
  CHECK(received->position_variance_m2 == 0.25);
}

TEST_CASE("a robot that seems to move at any speed is sent as its receivers accept it, in its direction") {
  const std::uint64_t seed = GENERATE(range(1u, 201u));
  CAPTURE(seed);
  Rng rng(seed);
  const double speed_mps = std::pow(10, rng.uniform(1.9, 16));
  const double angle_rad = rng.uniform(-4, 4);
  const Vec2 direction(std::cos(angle_rad), std::sin(angle_rad));
  const auto received = sent({7, kNow, {1, 2}, speed_mps * direction, 0});
  REQUIRE(received);
  CHECK(received->velocity_mps.norm() == Approx(std::min(speed_mps, kMaxSpeed_mps)));
  CHECK((received->velocity_mps.normalized() - direction).norm() < 1e-9);
}

}  // namespace sidestep::observation_codec_test
