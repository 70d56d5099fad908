// SPDX-License-Identifier: Apache-2.0
#include "common/league/tracked_packet.hpp"

#include "common/league/packet_validator.hpp"
#include "common/league/wire.hpp"

#include "league/tracked.pb.h"

namespace sidestep::league {
namespace {

constexpr double kMaxSpeed_mps = 100;
constexpr double kMaxAngularSpeed_radps = 1000;
constexpr int kMaxBalls = 128;
constexpr int kMaxRobotsPerTeam = 256;
enum TeamColour : std::uint32_t { kUnknown = 0, kYellow = 1, kBlue = 2 };

void write(const Vec2& vector, wire::tracked::Vector2& to) {
  to.set_x(static_cast<float>(vector.x()));
  to.set_y(static_cast<float>(vector.y()));
}

void write(const Vec3& vector, wire::tracked::Vector3& to) {
  to.set_x(static_cast<float>(vector.x()));
  to.set_y(static_cast<float>(vector.y()));
  to.set_z(static_cast<float>(vector.z()));
}

Vec2 read(const wire::tracked::Vector2& from, double bound, PacketValidator& validator) {
  return {validator.within(from.x(), bound), validator.within(from.y(), bound)};
}

Vec3 read(const wire::tracked::Vector3& from, double bound, PacketValidator& validator) {
  return {validator.within(from.x(), bound), validator.within(from.y(), bound),
          validator.within(from.z(), bound)};
}

void write(const TrackedBall& ball, wire::tracked::Ball& to) {
  write(ball.position_m, *to.mutable_pos());
  if (ball.velocity_mps) write(*ball.velocity_mps, *to.mutable_vel());
  if (ball.visibility) to.set_visibility(static_cast<float>(*ball.visibility));
}

TrackedBall read(const wire::tracked::Ball& from, PacketValidator& validator) {
  TrackedBall ball;
  ball.position_m = read(from.pos(), kMaxCoordinate_m, validator);
  if (from.has_vel()) ball.velocity_mps = read(from.vel(), kMaxSpeed_mps, validator);
  if (from.has_visibility()) ball.visibility = validator.probability(from.visibility());
  return ball;
}

std::uint32_t colour_of(const std::optional<Team>& team) {
  if (!team) return kUnknown;
  return *team == Team::kYellow ? kYellow : kBlue;
}

std::optional<Team> team_of(std::uint32_t colour, PacketValidator& validator) {
  validator.require(colour <= kBlue, DecodeError::kRobot);
  if (colour == kYellow) return Team::kYellow;
  if (colour == kBlue) return Team::kBlue;
  return std::nullopt;
}

void write(const TrackedRobot& robot, wire::tracked::Robot& to) {
  to.mutable_robot_id()->set_id(robot.number);
  to.mutable_robot_id()->set_team_color(colour_of(robot.team));
  write(robot.position_m, *to.mutable_pos());
  to.set_orientation(static_cast<float>(robot.heading_rad));
  if (robot.velocity_mps) write(*robot.velocity_mps, *to.mutable_vel());
  if (robot.angular_radps) to.set_vel_angular(static_cast<float>(*robot.angular_radps));
  if (robot.visibility) to.set_visibility(static_cast<float>(*robot.visibility));
}

TrackedRobot read(const wire::tracked::Robot& from, PacketValidator& validator) {
  TrackedRobot robot;
  validator.require(from.robot_id().id() < kRobotNumbers, DecodeError::kRobot);
  robot.number = from.robot_id().id();
  robot.team = team_of(from.robot_id().team_color(), validator);
  robot.position_m = read(from.pos(), kMaxCoordinate_m, validator);
  robot.heading_rad = wrapped_rad(validator.within(from.orientation(), kMaxHeading_rad));
  if (from.has_vel()) robot.velocity_mps = read(from.vel(), kMaxSpeed_mps, validator);
  if (from.has_vel_angular())
    robot.angular_radps = validator.within(from.vel_angular(), kMaxAngularSpeed_radps);
  if (from.has_visibility()) robot.visibility = validator.probability(from.visibility());
  return robot;
}

void write(const TrackedFrame& frame, wire::tracked::Frame& to) {
  to.set_frame_number(frame.frame_number);
  to.set_timestamp(to_seconds(frame.at));
  for (const TrackedBall& ball : frame.balls) write(ball, *to.add_balls());
  for (const TrackedRobot& robot : frame.robots) write(robot, *to.add_robots());
}

TrackedFrame read(const wire::tracked::Frame& from, PacketValidator& validator) {
  TrackedFrame frame;
  validator.at_most(from.balls(), kMaxBalls);
  validator.at_most(from.robots(), kMaxRobotsPerTeam);
  if (!validator.is_valid()) return frame;
  frame.frame_number = from.frame_number();
  frame.at = validator.time(from.timestamp());
  for (const auto& ball : from.balls()) frame.balls.push_back(read(ball, validator));
  for (const auto& robot : from.robots()) frame.robots.push_back(read(robot, validator));
  return frame;
}

}  // namespace

std::vector<std::byte> encode(const TrackedPacket& packet) {
  wire::tracked::Packet message;
  message.set_uuid(packet.uuid);
  if (packet.source_name) message.set_source_name(*packet.source_name);
  if (packet.frame) write(*packet.frame, *message.mutable_tracked_frame());
  return bytes_of(message);
}

Decoded<TrackedPacket> decode_tracked(std::span<const std::byte> bytes) {
  wire::tracked::Packet message;
  if (const DecodeError error = parse(bytes, message); error != DecodeError::kNone) return {{}, error};
  PacketValidator validator;
  TrackedPacket packet;
  packet.uuid = validator.text(message.uuid());
  if (message.has_source_name()) packet.source_name = validator.text(message.source_name());
  if (message.has_tracked_frame()) packet.frame = read(message.tracked_frame(), validator);
  if (!validator.is_valid()) return {{}, validator.error()};
  return {std::move(packet), DecodeError::kNone};
}

}  // namespace sidestep::league
