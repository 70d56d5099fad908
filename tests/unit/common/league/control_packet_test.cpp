// SPDX-License-Identifier: Apache-2.0
#include "common/league/control_packet.hpp"

#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/common/league/random_packets.hpp"

#include "league/control.pb.h"

namespace sidestep::league::control_packet_test {

std::vector<std::byte> bytes_of_numbers(std::initializer_list<int> numbers) {
  std::vector<std::byte> bytes;
  for (const int number : numbers) bytes.push_back(static_cast<std::byte>(number));
  return bytes;
}

TEST_CASE("team commands are read from wire bytes") {
  // robot_commands: id 5, move_command: local_velocity: forward 1, left -0.5, angular 2; kick_speed 4,
  // kick_angle 45.
  const auto bytes =
      bytes_of_numbers({0x0a, 0x1f,                                                           //
                        0x08, 0x05,                                                           //
                        0x12, 0x11,                                                           //
                        0x12, 0x0f,                                                           //
                        0x0d, 0,    0, 0x80, 0x3f, 0x15, 0, 0, 0, 0xbf, 0x1d, 0, 0, 0, 0x40,  //
                        0x1d, 0,    0, 0x80, 0x40,                                            //
                        0x25, 0,    0, 0x34, 0x42});
  const auto decoded = decode_team_commands(bytes);
  REQUIRE(decoded.error == DecodeError::kNone);
  REQUIRE(decoded.packet->robots.size() == 1);
  const RobotCommand& robot = decoded.packet->robots.front();
  CHECK(robot.number == 5);
  REQUIRE(robot.move);
  CHECK(robot.move->kind == RobotMove::Kind::kLocal);
  CHECK(robot.move->linear_mps == Vec2(1, -0.5));
  CHECK(robot.move->turn_radps == 2);
  CHECK(robot.kick_mps == 4);
  CHECK(robot.kick_angle_rad == Approx(0.7853981634));
}

TEST_CASE("a simulator command is read from wire bytes") {
  // control: teleport_robot: id {id 3, team 2 (blue)}, x 1, y -0.5, orientation 2, present true; speed 0.5.
  // config: geometry, vision_port 10020.
  const auto bytes = bytes_of_numbers({0x0a, 0x1e,                                      //
                                       0x12, 0x17, 0x0a, 0x04, 0x08, 0x03, 0x10, 0x02,  //
                                       0x15, 0,    0,    0x80, 0x3f, 0x1d, 0,    0,    0,
                                       0xbf, 0x25, 0,    0,    0,    0x40, 0x40, 0x01,  //
                                       0x1d, 0,    0,    0,    0x3f,                    //
                                       0x12, 0x05, 0x0a, 0x00, 0x20, 0xa4, 0x4e});
  const auto decoded = decode_simulator_command(bytes);
  REQUIRE(decoded.error == DecodeError::kNone);
  REQUIRE(decoded.packet->robots.size() == 1);
  const RobotTeleport& robot = decoded.packet->robots.front();
  CHECK(robot.team == Team::kBlue);
  CHECK(robot.number == 3);
  CHECK(robot.x_m == 1);
  CHECK(robot.y_m == -0.5);
  CHECK(robot.heading_rad == 2);
  CHECK(robot.is_present == true);
  CHECK(decoded.packet->speed == 0.5);
  CHECK(decoded.packet->has_geometry);
  CHECK_FALSE(decoded.packet->has_robot_specs);
  CHECK(decoded.packet->vision_port == 10020);
}

TEST_CASE("commands and responses survive encoding and decoding") {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    CAPTURE(seed);
    Rng rng(seed);
    const TeamCommands commands = test::random_team_commands(rng);
    const auto decoded = decode_team_commands(encode(commands));
    REQUIRE(decoded.error == DecodeError::kNone);
    REQUIRE(decoded.packet->robots.size() == commands.robots.size());
    for (std::size_t i = 0; i < commands.robots.size(); ++i) {
      const RobotCommand &a = decoded.packet->robots[i], &b = commands.robots[i];
      CHECK(a.number == b.number);
      REQUIRE(a.move.has_value() == b.move.has_value());
      if (b.move) CHECK(a.move->kind == b.move->kind);
      if (b.move && b.move->kind != RobotMove::Kind::kWheels)
        CHECK((a.move->linear_mps - b.move->linear_mps).norm() < 1e-5);
      CHECK(a.kick_mps == Approx(b.kick_mps).margin(1e-5));
    }
    const SimulatorCommand command = test::random_simulator_command(rng);
    const auto control = decode_simulator_command(encode(command));
    REQUIRE(control.error == DecodeError::kNone);
    REQUIRE(control.packet->robots.size() == command.robots.size());
    for (std::size_t i = 0; i < command.robots.size(); ++i) {
      CHECK(control.packet->robots[i].team == command.robots[i].team);
      CHECK(control.packet->robots[i].number == command.robots[i].number);
      CHECK(control.packet->robots[i].x_m.has_value() == command.robots[i].x_m.has_value());
      CHECK(control.packet->robots[i].is_present == command.robots[i].is_present);
    }
    CHECK(control.packet->ball.has_value() == command.ball.has_value());
  }
  CHECK(decode_team_response(encode(TeamResponse{{{"A", "b"}}, {{3, true}, {4, false}}}))
            .packet->feedback.size() == 2);
  CHECK(decode_team_response({}).packet->errors.empty());
  CHECK(decode_simulator_response(encode(SimulatorResponse{{{"A", "b"}}})).packet->errors.front().message ==
        "b");
  CHECK(decode_simulator_response({}).packet->errors.empty());
}

TEST_CASE("the feedback of a simulator after a backlog is accepted") {
  TeamResponse response;
  for (std::uint32_t i = 0; i < 88; ++i) response.feedback.push_back({i % 11, false});
  const auto decoded = decode_team_response(encode(response));
  REQUIRE(decoded.packet);
  CHECK(decoded.packet->feedback.size() == 88);
  response.feedback.resize(4097);
  CHECK(decode_team_response(encode(response)).error == DecodeError::kTooMany);
}

TEST_CASE("team commands with one invalid value are rejected as a whole") {
  const auto error_of = [](auto spoil) {
    wire::control::TeamCommands message;
    auto& robot = *message.add_robots();
    robot.set_id(3);
    auto& local = *robot.mutable_move()->mutable_local_velocity();
    local.set_forward(1), local.set_left(0), local.set_angular(0);
    spoil(message, robot);
    const std::string text = message.SerializePartialAsString();
    return decode_team_commands(std::as_bytes(std::span(text))).error;
  };
  using Message = wire::control::TeamCommands;
  using Robot = wire::control::RobotCommand;
  CHECK(error_of([](Message&, Robot&) {}) == DecodeError::kNone);
  CHECK(error_of([](Message&, Robot& r) { r.set_id(16); }) == DecodeError::kRobot);
  CHECK(error_of([](Message&, Robot& r) { r.clear_id(); }) == DecodeError::kMalformed);
  CHECK(error_of([](Message&, Robot& r) { r.mutable_move()->mutable_local_velocity()->clear_left(); }) ==
        DecodeError::kMalformed);
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 101.0f, -101.0f}) {
    CAPTURE(bad);
    CHECK(error_of([=](Message&, Robot& r) {
            r.mutable_move()->mutable_local_velocity()->set_forward(bad);
          }) == DecodeError::kNumber);
    CHECK(error_of([=](Message&, Robot& r) { r.set_kick_speed(bad); }) == DecodeError::kNumber);
    CHECK(error_of([=](Message&, Robot& r) {
            auto& global = *r.mutable_move()->mutable_global_velocity();
            global.set_x(0), global.set_y(bad), global.set_angular(0);
          }) == DecodeError::kNumber);
  }
  CHECK(error_of([](Message& m, Robot&) {
          for (int i = 0; i < 64; ++i) m.add_robots()->set_id(1);
        }) == DecodeError::kTooMany);
  CHECK(decode_team_commands({}).error == DecodeError::kEmpty);
}

TEST_CASE("simulator commands with one invalid value are rejected as a whole") {
  const auto error_of = [](auto spoil) {
    wire::control::SimulatorCommand message;
    auto& robot = *message.mutable_control()->add_teleport_robots();
    robot.mutable_id()->set_id(3);
    robot.mutable_id()->set_team(1);
    robot.set_x(1);
    spoil(*message.mutable_control(), robot);
    const std::string text = message.SerializePartialAsString();
    return decode_simulator_command(std::as_bytes(std::span(text))).error;
  };
  using Control = wire::control::Control;
  using Robot = wire::control::TeleportRobot;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(error_of([](Control&, Robot&) {}) == DecodeError::kNone);
  CHECK(error_of([](Control&, Robot& r) { r.mutable_id()->set_team(0); }) == DecodeError::kRobot);
  CHECK(error_of([](Control&, Robot& r) { r.mutable_id()->set_id(-1); }) == DecodeError::kRobot);
  CHECK(error_of([](Control&, Robot& r) { r.mutable_id()->clear_id(); }) == DecodeError::kRobot);
  CHECK(error_of([=](Control&, Robot& r) { r.set_x(nan); }) == DecodeError::kNumber);
  CHECK(error_of([](Control&, Robot& r) { r.set_orientation(8); }) == DecodeError::kNumber);
  CHECK(error_of([=](Control&, Robot& r) { r.set_v_y(nan); }) == DecodeError::kNumber);
  CHECK(error_of([](Control& c, Robot&) { c.set_simulation_speed(-1); }) == DecodeError::kNumber);
  CHECK(error_of([=](Control& c, Robot&) {
          c.mutable_teleport_ball()->set_x(nan), c.mutable_teleport_ball()->set_y(0);
        }) == DecodeError::kNumber);
}

}  // namespace sidestep::league::control_packet_test
