// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/disturbance_codec.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/ideal_agent.hpp"

namespace sidestep::disturbance_codec_test {

using std::chrono::milliseconds;
using test::disturbance;

RobotDisturbance place(RobotId robot, const Vec2& at_m, double heading_rad) {
  auto placing = disturbance(robot, msg::DisturbanceKind::DISTURBANCE_PLACE);
  placing.place_m = at_m;
  placing.heading_rad = heading_rad;
  return placing;
}

TEST_CASE("encoding and decoding a disturbance preserves it") {
  RobotDisturbance before = place(3, {3, 2}, -1);
  before.push_mps = {1, 2};
  before.grip = 0.5;
  before.clock_offset = milliseconds(6);
  before.duration = milliseconds(7);
  const auto after = decode(encode(before), {9, 6}, 0.09);
  REQUIRE(after);
  CHECK(after->robot == before.robot);
  CHECK(after->kind == before.kind);
  CHECK(after->push_mps == before.push_mps);
  CHECK(after->grip == before.grip);
  CHECK(after->place_m == before.place_m);
  CHECK(after->heading_rad == before.heading_rad);
  CHECK(after->clock_offset == before.clock_offset);
  CHECK(after->duration == before.duration);
}

TEST_CASE("an invalid disturbance is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto is_valid = [&](const RobotDisturbance& disturbance) {
    return decode(encode(disturbance), {9, 6}, 0.09).has_value();
  };
  auto push = disturbance(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  push.place_m.x() = nan;  // not used by a push
  CHECK(is_valid(push));
  push.push_mps.x() = nan;
  CHECK_FALSE(is_valid(push));
  push.push_mps.x() = -11;
  CHECK_FALSE(is_valid(push));
  for (const auto kind : {msg::DisturbanceKind::DISTURBANCE_SLIP, msg::DisturbanceKind::DISTURBANCE_BLOCK}) {
    auto lasting = disturbance(0, kind);
    CHECK(is_valid(lasting));
    lasting.duration = Duration{-1};
    CHECK_FALSE(is_valid(lasting));
    lasting.duration = Duration::max();
    CHECK_FALSE(is_valid(lasting));
    lasting.duration = Duration{1000};
    lasting.grip = nan;
    lasting.heading_rad = nan;
    CHECK_FALSE(is_valid(lasting));
    lasting.grip = 1.1;
    lasting.heading_rad = 1e9;
    CHECK_FALSE(is_valid(lasting));
  }
  CHECK(is_valid(place(0, {4.4, 2.9}, 3)));
  CHECK_FALSE(is_valid(place(0, {4.42, 0}, 0)));
  CHECK_FALSE(is_valid(place(0, {nan, 0}, 0)));
  CHECK_FALSE(is_valid(place(0, {0, 0}, nan)));
  auto clock = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CLOCK);
  clock.clock_offset = std::chrono::hours(-1);
  CHECK(is_valid(clock));
  clock.clock_offset = Duration::min();
  CHECK_FALSE(is_valid(clock));
  CHECK_FALSE(is_valid(disturbance(0, static_cast<msg::DisturbanceKind>(14))));
  CHECK_FALSE(is_valid(disturbance(0, static_cast<msg::DisturbanceKind>(-1))));
  CHECK(is_valid(disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT)));
  CHECK(is_valid(disturbance(0, msg::DisturbanceKind::DISTURBANCE_REBOOT)));
  CHECK(is_valid(disturbance(0, msg::DisturbanceKind::DISTURBANCE_FORGET_POSE)));
}

}  // namespace sidestep::disturbance_codec_test
