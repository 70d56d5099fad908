// SPDX-License-Identifier: Apache-2.0
#include "common/robot/robot_version.hpp"

#include "common/messaging/version_codec.hpp"
#include "common/random/rng.hpp"
#include "common/robot/conversion.hpp"
#include "tests/catch.hpp"
#include "tests/unit/common/robot/random_version.hpp"

namespace sidestep {

TEST_CASE("a version repeated by the robot side equals the received version bit for bit") {
  Rng rng(21);
  for (int i = 0; i < 1000; ++i) {
    const msg::Version received = encode(test::random_version(7, 100 + static_cast<VersionNumber>(i), rng));
    const auto decoded = decode(received);
    REQUIRE(decoded);
    CHECK(encode(from_plain(to_plain(*decoded), 7)) == received);
  }
}

TEST_CASE("the robot side follows a version as other processes do, within 3 um in single precision") {
  Rng rng(22);
  for (int i = 0; i < 300; ++i) {
    const Version version = test::random_version(7, 100, rng);
    const robot::Version plain = to_plain(version);
    CHECK(plain.end_ns() == to_ns(version.trajectory.end()));
    const std::int64_t start = plain.start_ns, length = plain.end_ns() - start;
    for (int k = -1; k <= 11; ++k) {
      const std::int64_t t = start + length * k / 10;
      const Motion expected = version.trajectory.motion_at(time_from_ns(t));
      const auto exact = robot::motion_at<double>(plain, t);
      CHECK(Vec2(exact.position_m.x, exact.position_m.y) == expected.state.position_m);
      CHECK(Vec2(exact.velocity_mps.x, exact.velocity_mps.y) == expected.state.velocity_mps);
      CHECK(Vec2(exact.acceleration_mps2.x, exact.acceleration_mps2.y) == expected.acceleration_mps2);
      const auto single = robot::motion_at<float>(plain, t);
      const Vec2 position_m(single.position_m.x, single.position_m.y);
      const Vec2 velocity_mps(single.velocity_mps.x, single.velocity_mps.y);
      CHECK((position_m - expected.state.position_m).norm() < 3e-6);
      CHECK((velocity_mps - expected.state.velocity_mps).norm() < 3e-6);
    }
  }
}

}  // namespace sidestep
