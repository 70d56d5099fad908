// SPDX-License-Identifier: Apache-2.0
#include "common/league/referee_packet.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/league/random_packets.hpp"

#include "league/referee.pb.h"

namespace sidestep::league::referee_packet_test {

std::vector<std::byte> bytes_of_numbers(std::initializer_list<int> numbers) {
  std::vector<std::byte> bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

DecodeError error_of(const wire::referee::Packet& message) {
  const std::string text = message.SerializePartialAsString();
  return decode_referee(std::as_bytes(std::span(text))).error;
}

TEST_CASE("a referee packet is read from wire bytes") {
  // packet_timestamp 1.5 s, stage 2, command 16, command_counter 300, command_timestamp 1 s, a team with a
  // goalkeeper and eleven robots, designated_position (1500, -500) mm, next_command 3.
  const auto bytes = bytes_of_numbers({0x08, 0xe0, 0xc6, 0x5b,                                            //
                                       0x10, 0x02,                                                        //
                                       0x20, 0x10,                                                        //
                                       0x28, 0xac, 0x02,                                                  //
                                       0x30, 0xc0, 0x84, 0x3d,                                            //
                                       0x3a, 0x04, 0x40, 0x05, 0x68, 0x0b,                                //
                                       0x4a, 0x0a, 0x0d, 0,    0x80, 0xbb, 0x44, 0x15, 0, 0, 0xfa, 0xc3,  //
                                       0x60, 0x03});
  const auto decoded = decode_referee(bytes);
  REQUIRE(decoded.error == DecodeError::kNone);
  CHECK(decoded.packet->sent == std::chrono::milliseconds(1500));
  CHECK(decoded.packet->command == RefereeCommand::kBallPlacementYellow);
  CHECK(decoded.packet->command_counter == 300);
  CHECK(decoded.packet->commanded == std::chrono::seconds(1));
  REQUIRE(decoded.packet->designated_position_m);
  CHECK((*decoded.packet->designated_position_m - Vec2(1.5, -0.5)).norm() < 1e-9);
}

TEST_CASE("a referee packet survives encoding and decoding") {
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const RefereePacket packet = test::random_referee_packet(rng);
    const auto decoded = decode_referee(encode(packet));
    REQUIRE(decoded.error == DecodeError::kNone);
    CHECK(std::chrono::abs(decoded.packet->sent - packet.sent) < std::chrono::microseconds(2));
    CHECK(decoded.packet->command == packet.command);
    CHECK(decoded.packet->command_counter == packet.command_counter);
    CHECK(std::chrono::abs(decoded.packet->commanded - packet.commanded) < std::chrono::microseconds(2));
    const auto &a = decoded.packet->designated_position_m, &b = packet.designated_position_m;
    REQUIRE(a.has_value() == b.has_value());
    CHECK((!a || (*a - *b).norm() < 1e-5));
  }
}

TEST_CASE("an invalid referee packet is rejected with the reason") {
  const auto bytes = encode(RefereePacket{std::chrono::seconds(1), RefereeCommand::kStop, 1, {}, Vec2(1, 2)});
  wire::referee::Packet valid;
  REQUIRE(valid.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())));
  const auto after = [&](auto change) {
    wire::referee::Packet message = valid;
    change(message);
    return error_of(message);
  };
  using P = wire::referee::Packet;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(after([](P&) {}) == DecodeError::kNone);
  CHECK(after([](P& p) { p.clear_yellow(); }) == DecodeError::kNone);
  CHECK(after([](P& p) { p.clear_command(); }) == DecodeError::kMalformed);
  CHECK(after([](P& p) { p.clear_packet_timestamp(); }) == DecodeError::kMalformed);
  CHECK(after([](P& p) { p.mutable_designated_position()->clear_y(); }) == DecodeError::kMalformed);
  CHECK(after([](P& p) { p.set_command(18); }) == DecodeError::kCommand);
  CHECK(after([](P& p) { p.set_command(-1); }) == DecodeError::kCommand);
  CHECK(after([](P& p) { p.set_packet_timestamp(std::numeric_limits<std::uint64_t>::max()); }) ==
        DecodeError::kTime);
  CHECK(after([](P& p) { p.set_command_timestamp(8'589'934'593'000'000); }) == DecodeError::kTime);
  CHECK(after([&](P& p) { p.mutable_designated_position()->set_x(nan); }) == DecodeError::kNumber);
  CHECK(after([](P& p) { p.mutable_designated_position()->set_y(-10'000'001); }) == DecodeError::kNumber);
  CHECK(decode_referee({}).error == DecodeError::kEmpty);
  CHECK(decode_referee(std::vector<std::byte>(kMaxDatagramSize + 1)).error == DecodeError::kTooLong);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const auto part = decode_referee(std::span(bytes).first(size));
    CHECK(part.packet.has_value() == (part.error == DecodeError::kNone));
  }
}

TEST_CASE("referee commands have the league's names and teams") {
  CHECK(name_of(RefereeCommand::kHalt) == "HALT");
  CHECK(name_of(RefereeCommand::kForceStart) == "FORCE_START");
  CHECK(name_of(static_cast<RefereeCommand>(9)) == "DIRECT_FREE_BLUE");
  CHECK(name_of(static_cast<RefereeCommand>(17)) == "BALL_PLACEMENT_BLUE");
  CHECK_FALSE(team_of(RefereeCommand::kHalt));
  CHECK_FALSE(team_of(RefereeCommand::kForceStart));
  for (std::size_t i = 4; i < kRefereeCommands; ++i) {
    const auto command = static_cast<RefereeCommand>(i);
    CAPTURE(name_of(command));
    CHECK(team_of(command) == (name_of(command).ends_with("_BLUE") ? Team::kBlue : Team::kYellow));
  }
}

}  // namespace sidestep::league::referee_packet_test
