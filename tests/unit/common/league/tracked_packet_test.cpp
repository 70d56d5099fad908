// SPDX-License-Identifier: Apache-2.0
#include "common/league/tracked_packet.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/league/random_packets.hpp"

#include "league/tracked.pb.h"

namespace sidestep::league::tracked_packet_test {

wire::tracked::Packet message_of(std::span<const std::byte> bytes) {
  wire::tracked::Packet message;
  REQUIRE(message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
  return message;
}

DecodeError error_of(const wire::tracked::Packet& message) {
  const std::string text = message.SerializePartialAsString();
  return decode_tracked(std::as_bytes(std::span(text))).error;
}

template <typename Vector>
bool is_close(const Vector& a, const Vector& b) {
  return (a - b).norm() < 1e-5;
}

template <typename Vector>
bool is_close(const std::optional<Vector>& a, const std::optional<Vector>& b) {
  return a.has_value() == b.has_value() && (!a || is_close(*a, *b));
}

bool is_close(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && (!a || std::abs(*a - *b) < 1e-5);
}

TEST_CASE("a tracked packet survives encoding and decoding") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const TrackedPacket packet = test::random_tracked_packet(rng);
    const auto decoded = decode_tracked(encode(packet));
    REQUIRE(decoded.error == DecodeError::kNone);
    CHECK(decoded.packet->uuid == packet.uuid);
    CHECK(decoded.packet->source_name == packet.source_name);
    REQUIRE(decoded.packet->frame.has_value() == packet.frame.has_value());
    if (!packet.frame) continue;
    const TrackedFrame &a = *decoded.packet->frame, &b = *packet.frame;
    CHECK(a.frame_number == b.frame_number);
    CHECK(std::chrono::abs(a.at - b.at) < std::chrono::microseconds(1));
    REQUIRE(a.balls.size() == b.balls.size());
    for (std::size_t i = 0; i < a.balls.size(); ++i) {
      CHECK(is_close(a.balls[i].position_m, b.balls[i].position_m));
      CHECK(is_close(a.balls[i].velocity_mps, b.balls[i].velocity_mps));
      CHECK(is_close(a.balls[i].visibility, b.balls[i].visibility));
    }
    REQUIRE(a.robots.size() == b.robots.size());
    for (std::size_t i = 0; i < a.robots.size(); ++i) {
      CHECK(a.robots[i].team == b.robots[i].team);
      CHECK(a.robots[i].number == b.robots[i].number);
      CHECK(is_close(a.robots[i].position_m, b.robots[i].position_m));
      CHECK(a.robots[i].heading_rad == Approx(b.robots[i].heading_rad).margin(1e-6));
      CHECK(is_close(a.robots[i].velocity_mps, b.robots[i].velocity_mps));
      CHECK(is_close(a.robots[i].angular_radps, b.robots[i].angular_radps));
      CHECK(is_close(a.robots[i].visibility, b.robots[i].visibility));
    }
  }
}

TEST_CASE("tracked robots are encoded in metres and with the league's team colours") {
  TrackedFrame frame;
  frame.frame_number = 4;
  frame.at = std::chrono::milliseconds(1'500);
  frame.robots.push_back({Team::kBlue, 3, {1.5, -2}, 0.5, Vec2(1, 0), 2.0, 1.0});
  frame.robots.push_back({Team::kYellow, 3, {0, 0}, 0, {}, {}, {}});
  const auto message = message_of(encode(TrackedPacket{"a-b", "Sidestep", frame}));
  CHECK(message.uuid() == "a-b");
  CHECK(message.source_name() == "Sidestep");
  CHECK(message.tracked_frame().timestamp() == 1.5);
  REQUIRE(message.tracked_frame().robots_size() == 2);
  const auto& blue = message.tracked_frame().robots(0);
  CHECK(blue.robot_id().id() == 3);
  CHECK(blue.robot_id().team_color() == 2);
  CHECK(blue.pos().x() == 1.5F);
  CHECK(blue.pos().y() == -2.0F);
  CHECK(blue.orientation() == 0.5F);
  CHECK(blue.vel().x() == 1.0F);
  CHECK(blue.vel_angular() == 2.0F);
  CHECK(message.tracked_frame().robots(1).robot_id().team_color() == 1);
  CHECK_FALSE(message.tracked_frame().robots(1).has_vel());
}

TEST_CASE("an invalid tracked packet is rejected with the reason") {
  Rng rng(3);
  TrackedPacket packet{"id", std::nullopt, TrackedFrame{}};
  packet.frame->robots.push_back({Team::kBlue, 3, {1.5, -2}, 0.5, Vec2(1, 0), 2.0, 1.0});
  packet.frame->balls.emplace_back();
  const auto valid = message_of(encode(packet));
  const auto after = [&](auto change) {
    wire::tracked::Packet message = valid;
    change(message);
    return error_of(message);
  };
  using P = wire::tracked::Packet;
  const auto robot = [](P& p) { return p.mutable_tracked_frame()->mutable_robots(0); };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(after([](P&) {}) == DecodeError::kNone);
  CHECK(after([&](P& p) { robot(p)->mutable_pos()->set_x(nan); }) == DecodeError::kNumber);
  CHECK(after([&](P& p) { robot(p)->mutable_vel()->set_y(101); }) == DecodeError::kNumber);
  CHECK(after([&](P& p) { robot(p)->set_vel_angular(nan); }) == DecodeError::kNumber);
  CHECK(after([&](P& p) { robot(p)->set_orientation(8); }) == DecodeError::kNumber);
  CHECK(after([&](P& p) { robot(p)->set_visibility(-0.5F); }) == DecodeError::kNumber);
  CHECK(after([&](P& p) { robot(p)->mutable_robot_id()->set_id(16); }) == DecodeError::kRobot);
  CHECK(after([&](P& p) { robot(p)->mutable_robot_id()->set_team_color(3); }) == DecodeError::kRobot);
  CHECK(after([&](P& p) { robot(p)->clear_pos(); }) == DecodeError::kMalformed);
  CHECK(after([](P& p) { p.clear_uuid(); }) == DecodeError::kMalformed);
  CHECK(after([](P& p) { p.set_uuid(std::string(257, 'x')); }) == DecodeError::kText);
  CHECK(after([](P& p) { p.mutable_tracked_frame()->set_timestamp(-1); }) == DecodeError::kTime);
  CHECK(after([](P& p) {
          auto& frame = *p.mutable_tracked_frame();
          while (frame.robots_size() < 257) *frame.add_robots() = frame.robots(0);
        }) == DecodeError::kTooMany);
}

}  // namespace sidestep::league::tracked_packet_test
