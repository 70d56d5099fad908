// SPDX-License-Identifier: Apache-2.0
#include "common/league/vision_packet.hpp"

#include "common/league/field_wire.hpp"
#include "common/league/packet_validator.hpp"
#include "common/league/wire.hpp"

#include "league/vision.pb.h"

namespace sidestep::league {
namespace {

constexpr int kMaxBalls = 128;
constexpr int kMaxRobotsPerTeam = 64;  // a camera may report one robot several times
constexpr double kMaxPixel = 1e6;
constexpr double kMaxRobotHeight_m = 2, kMaxBallHeight_m = 100;

float in_mm(double length_m) { return static_cast<float>(length_m * 1e3); }

void write(const DetectedBall& ball, wire::vision::Ball& to) {
  to.set_confidence(static_cast<float>(ball.confidence));
  if (ball.area) to.set_area(*ball.area);
  to.set_x(in_mm(ball.position_m.x()));
  to.set_y(in_mm(ball.position_m.y()));
  if (ball.height_m) to.set_z(in_mm(*ball.height_m));
  to.set_pixel_x(static_cast<float>(ball.pixel.x()));
  to.set_pixel_y(static_cast<float>(ball.pixel.y()));
}

DetectedBall read(const wire::vision::Ball& from, PacketValidator& validator) {
  DetectedBall ball;
  ball.confidence = validator.probability(from.confidence());
  if (from.has_area()) ball.area = from.area();
  ball.position_m = {validator.within(from.x() * 1e-3, kMaxCoordinate_m),
                     validator.within(from.y() * 1e-3, kMaxCoordinate_m)};
  if (from.has_z()) ball.height_m = validator.within(from.z() * 1e-3, kMaxBallHeight_m);
  ball.pixel = {validator.within(from.pixel_x(), kMaxPixel), validator.within(from.pixel_y(), kMaxPixel)};
  return ball;
}

void write(const DetectedRobot& robot, wire::vision::Robot& to) {
  to.set_confidence(static_cast<float>(robot.confidence));
  if (robot.number) to.set_robot_id(*robot.number);
  to.set_x(in_mm(robot.position_m.x()));
  to.set_y(in_mm(robot.position_m.y()));
  if (robot.heading_rad) to.set_orientation(static_cast<float>(*robot.heading_rad));
  to.set_pixel_x(static_cast<float>(robot.pixel.x()));
  to.set_pixel_y(static_cast<float>(robot.pixel.y()));
  if (robot.height_m) to.set_height(in_mm(*robot.height_m));
}

DetectedRobot read(const wire::vision::Robot& from, PacketValidator& validator) {
  DetectedRobot robot;
  robot.confidence = validator.probability(from.confidence());
  validator.require(!from.has_robot_id() || from.robot_id() < kRobotNumbers, DecodeError::kRobot);
  if (from.has_robot_id()) robot.number = from.robot_id();
  robot.position_m = {validator.within(from.x() * 1e-3, kMaxCoordinate_m),
                      validator.within(from.y() * 1e-3, kMaxCoordinate_m)};
  if (from.has_orientation()) {
    robot.heading_rad = wrapped_rad(validator.within(from.orientation(), kMaxHeading_rad));
  }
  robot.pixel = {validator.within(from.pixel_x(), kMaxPixel), validator.within(from.pixel_y(), kMaxPixel)};
  if (from.has_height()) robot.height_m = validator.within(from.height() * 1e-3, 0, kMaxRobotHeight_m);
  return robot;
}

void write(const DetectionFrame& detection, wire::vision::DetectionFrame& to) {
  to.set_frame_number(detection.frame_number);
  to.set_t_capture(to_seconds(detection.captured));
  to.set_t_sent(to_seconds(detection.sent));
  to.set_camera_id(detection.camera);
  for (const DetectedBall& ball : detection.balls) write(ball, *to.add_balls());
  for (const DetectedRobot& robot : detection.yellow) write(robot, *to.add_robots_yellow());
  for (const DetectedRobot& robot : detection.blue) write(robot, *to.add_robots_blue());
  if (detection.captured_by_camera) to.set_t_capture_camera(to_seconds(*detection.captured_by_camera));
}

DetectionFrame read(const wire::vision::DetectionFrame& from, PacketValidator& validator) {
  DetectionFrame detection;
  validator.at_most(from.balls(), kMaxBalls);
  validator.at_most(from.robots_yellow(), kMaxRobotsPerTeam);
  validator.at_most(from.robots_blue(), kMaxRobotsPerTeam);
  validator.require(from.camera_id() < kMaxCameras, DecodeError::kCamera);
  if (!validator.is_valid()) return detection;
  detection.frame_number = from.frame_number();
  detection.camera = from.camera_id();
  detection.captured = validator.sender_time(from.t_capture());
  detection.sent = validator.sender_time(from.t_sent());
  if (from.has_t_capture_camera())
    detection.captured_by_camera = validator.sender_time(from.t_capture_camera());
  for (const auto& ball : from.balls()) detection.balls.push_back(read(ball, validator));
  for (const auto& robot : from.robots_yellow()) detection.yellow.push_back(read(robot, validator));
  for (const auto& robot : from.robots_blue()) detection.blue.push_back(read(robot, validator));
  return detection;
}

}  // namespace

std::vector<std::byte> encode(const VisionPacket& packet) {
  wire::vision::Packet message;
  if (packet.detection) write(*packet.detection, *message.mutable_detection());
  if (packet.geometry) write(*packet.geometry, *message.mutable_geometry());
  if (packet.source) message.set_source(*packet.source);
  return bytes_of(message);
}

Decoded<VisionPacket> decode_vision(std::span<const std::byte> bytes) {
  wire::vision::Packet message;
  if (const DecodeError error = parse(bytes, message); error != DecodeError::kNone) return {{}, error};
  if (!message.has_detection() && !message.has_geometry()) return {{}, DecodeError::kEmpty};
  PacketValidator validator;
  VisionPacket packet;
  if (message.has_detection()) packet.detection = read(message.detection(), validator);
  if (message.has_geometry()) packet.geometry = read(message.geometry(), validator);
  if (message.has_source()) packet.source = message.source();
  if (!validator.is_valid()) return {{}, validator.error()};
  return {std::move(packet), DecodeError::kNone};
}

}  // namespace sidestep::league
