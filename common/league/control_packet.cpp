// SPDX-License-Identifier: Apache-2.0
#include "common/league/control_packet.hpp"

#include <numbers>

#include "common/league/packet_validator.hpp"
#include "common/league/wire.hpp"

#include "league/control.pb.h"

namespace sidestep::league {
namespace {

constexpr int kMaxRobots = 64, kMaxErrors = 64;
constexpr int kMaxFeedback = 4096;  // after a backlog, simulators answer many commands in one packet
constexpr double kMaxSpeed_mps = 100, kMaxTurn_radps = 1000, kMaxWheel_mps = 1000, kMaxSimulationSpeed = 100;
constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr int kYellow = 1, kBlue = 2;

float single(double value) { return static_cast<float>(value); }

std::uint32_t read_number(std::uint32_t id, PacketValidator& validator) {
  validator.require(id < kRobotNumbers, DecodeError::kRobot);
  return id;
}

Vec2 read_velocity(double x, double y, PacketValidator& validator) {
  return {validator.within(x, kMaxSpeed_mps), validator.within(y, kMaxSpeed_mps)};
}

void write(const RobotMove& move, wire::control::Move& to) {
  const float x = single(move.linear_mps.x()), y = single(move.linear_mps.y()),
              turn = single(move.turn_radps);
  if (move.kind == RobotMove::Kind::kLocal) {
    auto& local = *to.mutable_local_velocity();
    local.set_forward(x), local.set_left(y), local.set_angular(turn);
  } else if (move.kind == RobotMove::Kind::kGlobal) {
    auto& global = *to.mutable_global_velocity();
    global.set_x(x), global.set_y(y), global.set_angular(turn);
  } else {
    auto& wheels = *to.mutable_wheel_velocity();
    wheels.set_front_right(0), wheels.set_back_right(0), wheels.set_back_left(0), wheels.set_front_left(0);
  }
}

std::optional<RobotMove> read(const wire::control::Move& from, PacketValidator& validator) {
  RobotMove move;
  if (from.has_local_velocity()) {
    const auto& local = from.local_velocity();
    move.linear_mps = read_velocity(local.forward(), local.left(), validator);
    move.turn_radps = validator.within(local.angular(), kMaxTurn_radps);
  } else if (from.has_global_velocity()) {
    const auto& global = from.global_velocity();
    move.kind = RobotMove::Kind::kGlobal;
    move.linear_mps = read_velocity(global.x(), global.y(), validator);
    move.turn_radps = validator.within(global.angular(), kMaxTurn_radps);
  } else if (from.has_wheel_velocity()) {
    const auto& wheels = from.wheel_velocity();
    move.kind = RobotMove::Kind::kWheels;
    for (const float speed :
         {wheels.front_right(), wheels.back_right(), wheels.back_left(), wheels.front_left()})
      validator.within(speed, kMaxWheel_mps);
  } else {
    return std::nullopt;
  }
  return move;
}

template <typename Errors, typename List>
void write_errors(const Errors& errors, List& to) {
  for (const SimulatorError& error : errors) {
    auto& message = *to.Add();
    message.set_code(error.code);
    message.set_message(error.message);
  }
}

template <typename List>
std::vector<SimulatorError> read_errors(const List& from, PacketValidator& validator) {
  std::vector<SimulatorError> errors;
  validator.at_most(from, kMaxErrors);
  if (!validator.is_valid()) return errors;
  for (const auto& error : from)
    errors.push_back({validator.text(error.code()), validator.text(error.message())});
  return errors;
}

void write(const RobotTeleport& teleport, wire::control::TeleportRobot& to) {
  to.mutable_id()->set_id(static_cast<std::int32_t>(teleport.number));
  to.mutable_id()->set_team(teleport.team == Team::kYellow ? kYellow : kBlue);
  if (teleport.x_m) to.set_x(single(*teleport.x_m));
  if (teleport.y_m) to.set_y(single(*teleport.y_m));
  if (teleport.heading_rad) to.set_orientation(single(*teleport.heading_rad));
  to.set_v_x(single(teleport.velocity_mps.x()));
  to.set_v_y(single(teleport.velocity_mps.y()));
  to.set_v_angular(single(teleport.turn_radps));
  if (teleport.is_present) to.set_present(*teleport.is_present);
}

RobotTeleport read(const wire::control::TeleportRobot& from, PacketValidator& validator) {
  RobotTeleport teleport;
  validator.require(from.id().team() == kYellow || from.id().team() == kBlue, DecodeError::kRobot);
  teleport.team = from.id().team() == kYellow ? Team::kYellow : Team::kBlue;
  validator.require(from.id().has_id(), DecodeError::kRobot);
  teleport.number = read_number(static_cast<std::uint32_t>(from.id().id()), validator);
  if (from.has_x()) teleport.x_m = validator.within(from.x(), kMaxCoordinate_m);
  if (from.has_y()) teleport.y_m = validator.within(from.y(), kMaxCoordinate_m);
  if (from.has_orientation())
    teleport.heading_rad = wrapped_rad(validator.within(from.orientation(), kMaxHeading_rad));
  teleport.velocity_mps = read_velocity(from.v_x(), from.v_y(), validator);
  teleport.turn_radps = validator.within(from.v_angular(), kMaxTurn_radps);
  if (from.has_present()) teleport.is_present = from.present();
  return teleport;
}

BallTeleport read(const wire::control::TeleportBall& from, PacketValidator& validator) {
  BallTeleport ball;
  if (from.has_x() && from.has_y())
    ball.position_m =
        Vec2(validator.within(from.x(), kMaxCoordinate_m), validator.within(from.y(), kMaxCoordinate_m));
  if (from.has_vx() || from.has_vy()) ball.velocity_mps = read_velocity(from.vx(), from.vy(), validator);
  return ball;
}

// A response without content is an empty datagram.
template <typename Message>
DecodeError parse_answer(std::span<const std::byte> bytes, Message& message) {
  return bytes.empty() ? DecodeError::kNone : parse(bytes, message);
}

template <typename Packet>
Decoded<Packet> checked(Packet packet, const PacketValidator& validator) {
  if (!validator.is_valid()) return {{}, validator.error()};
  return {std::move(packet), DecodeError::kNone};
}

}  // namespace

std::vector<std::byte> encode(const TeamCommands& packet) {
  wire::control::TeamCommands message;
  for (const RobotCommand& robot : packet.robots) {
    auto& to = *message.add_robots();
    to.set_id(robot.number);
    if (robot.move) write(*robot.move, *to.mutable_move());
    to.set_kick_speed(single(robot.kick_mps));
    to.set_kick_angle(single(robot.kick_angle_rad / kRadPerDegree));
  }
  return bytes_of(message);
}

Decoded<TeamCommands> decode_team_commands(std::span<const std::byte> bytes) {
  wire::control::TeamCommands message;
  if (const DecodeError error = parse(bytes, message); error != DecodeError::kNone) return {{}, error};
  PacketValidator validator;
  validator.at_most(message.robots(), kMaxRobots);
  if (!validator.is_valid()) return {{}, validator.error()};
  TeamCommands packet;
  for (const auto& from : message.robots()) {
    RobotCommand robot;
    robot.number = read_number(from.id(), validator);
    if (from.has_move()) robot.move = read(from.move(), validator);
    robot.kick_mps = validator.within(from.kick_speed(), 0, kMaxSpeed_mps);
    robot.kick_angle_rad = kRadPerDegree * validator.within(from.kick_angle(), 360);
    packet.robots.push_back(robot);
  }
  return checked(std::move(packet), validator);
}

std::vector<std::byte> encode(const TeamResponse& packet) {
  wire::control::TeamResponse message;
  write_errors(packet.errors, *message.mutable_errors());
  for (const RobotFeedback& robot : packet.feedback) {
    auto& to = *message.add_feedback();
    to.set_id(robot.number);
    to.set_dribbler_ball_contact(robot.has_ball);
  }
  return bytes_of(message);
}

Decoded<TeamResponse> decode_team_response(std::span<const std::byte> bytes) {
  wire::control::TeamResponse message;
  if (const DecodeError error = parse_answer(bytes, message); error != DecodeError::kNone) return {{}, error};
  PacketValidator validator;
  TeamResponse packet;
  packet.errors = read_errors(message.errors(), validator);
  validator.at_most(message.feedback(), kMaxFeedback);
  if (!validator.is_valid()) return {{}, validator.error()};
  for (const auto& from : message.feedback())
    packet.feedback.push_back({read_number(from.id(), validator), from.dribbler_ball_contact()});
  return checked(std::move(packet), validator);
}

std::vector<std::byte> encode(const SimulatorCommand& packet) {
  wire::control::SimulatorCommand message;
  auto& control = *message.mutable_control();
  if (packet.ball) {
    auto& ball = *control.mutable_teleport_ball();
    if (packet.ball->position_m)
      ball.set_x(single(packet.ball->position_m->x())), ball.set_y(single(packet.ball->position_m->y()));
    if (packet.ball->velocity_mps)
      ball.set_vx(single(packet.ball->velocity_mps->x())),
          ball.set_vy(single(packet.ball->velocity_mps->y()));
  }
  for (const RobotTeleport& teleport : packet.robots) write(teleport, *control.add_teleport_robots());
  if (packet.speed) control.set_simulation_speed(single(*packet.speed));
  if (packet.has_geometry) message.mutable_config()->mutable_geometry();
  if (packet.has_robot_specs) message.mutable_config()->add_robot_specs();
  if (packet.has_realism) message.mutable_config()->mutable_realism();
  if (packet.vision_port) message.mutable_config()->set_vision_port(*packet.vision_port);
  return bytes_of(message);
}

Decoded<SimulatorCommand> decode_simulator_command(std::span<const std::byte> bytes) {
  wire::control::SimulatorCommand message;
  if (const DecodeError error = parse(bytes, message); error != DecodeError::kNone) return {{}, error};
  const auto& control = message.control();
  PacketValidator validator;
  validator.at_most(control.teleport_robots(), kMaxRobots);
  if (!validator.is_valid()) return {{}, validator.error()};
  SimulatorCommand packet;
  if (control.has_teleport_ball()) packet.ball = read(control.teleport_ball(), validator);
  for (const auto& teleport : control.teleport_robots()) packet.robots.push_back(read(teleport, validator));
  if (control.has_simulation_speed())
    packet.speed = validator.within(control.simulation_speed(), 0, kMaxSimulationSpeed);
  packet.has_geometry = message.config().has_geometry();
  packet.has_robot_specs = message.config().robot_specs_size() > 0;
  packet.has_realism = message.config().has_realism();
  if (message.config().has_vision_port()) packet.vision_port = message.config().vision_port();
  return checked(std::move(packet), validator);
}

std::vector<std::byte> encode(const SimulatorResponse& packet) {
  wire::control::SimulatorResponse message;
  write_errors(packet.errors, *message.mutable_errors());
  return bytes_of(message);
}

Decoded<SimulatorResponse> decode_simulator_response(std::span<const std::byte> bytes) {
  wire::control::SimulatorResponse message;
  if (const DecodeError error = parse_answer(bytes, message); error != DecodeError::kNone) return {{}, error};
  PacketValidator validator;
  SimulatorResponse packet;
  packet.errors = read_errors(message.errors(), validator);
  return checked(std::move(packet), validator);
}

}  // namespace sidestep::league
