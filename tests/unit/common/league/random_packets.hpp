// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "common/league/control_packet.hpp"
#include "common/league/referee_packet.hpp"
#include "common/league/tracked_packet.hpp"
#include "common/league/vision_packet.hpp"
#include "common/random/rng.hpp"

namespace sidestep::league::test {

inline Vec2 random_vec2(Rng& rng, double bound) {
  return {rng.uniform(-bound, bound), rng.uniform(-bound, bound)};
}
inline Vec3 random_vec3(Rng& rng, double bound) {
  return {rng.uniform(-bound, bound), rng.uniform(-bound, bound), rng.uniform(-bound, bound)};
}
inline std::uint32_t random_u32(Rng& rng) { return static_cast<std::uint32_t>(rng.bits()); }
inline std::string random_text(Rng& rng) {
  std::string text(rng.below(40), ' ');
  for (char& c : text) c = static_cast<char>('A' + rng.below(26));
  return text;
}
/// The result of `make` with probability 0.5.
template <typename Make>
auto maybe(Rng& rng, Make make) -> std::optional<decltype(make())> {
  return rng.chance(0.5) ? std::optional(make()) : std::nullopt;
}

inline DetectedBall random_ball(Rng& rng) {
  DetectedBall ball;
  ball.position_m = random_vec2(rng, 10);
  ball.height_m = maybe(rng, [&] { return rng.uniform(0, 3); });
  ball.confidence = rng.uniform();
  ball.pixel = random_vec2(rng, 2000);
  ball.area = maybe(rng, [&] { return random_u32(rng); });
  return ball;
}

inline DetectedRobot random_robot(Rng& rng) {
  DetectedRobot robot;
  robot.number = maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(kRobotNumbers)); });
  robot.position_m = random_vec2(rng, 10);
  robot.heading_rad = maybe(rng, [&] { return rng.uniform(-3.14, 3.14); });
  robot.confidence = rng.uniform();
  robot.pixel = random_vec2(rng, 2000);
  robot.height_m = maybe(rng, [&] { return rng.uniform(0.1, 0.2); });
  return robot;
}

inline DetectionFrame random_detection(Rng& rng) {
  DetectionFrame detection;
  detection.frame_number = random_u32(rng);
  detection.camera = static_cast<std::uint32_t>(rng.below(kMaxCameras));
  detection.captured = from_seconds(rng.chance(0.5) ? rng.uniform(0, 1000) : rng.uniform(1.7e9, 1.8e9));
  detection.sent = detection.captured + from_seconds(rng.uniform(0, 0.1));
  detection.captured_by_camera = maybe(rng, [&] { return from_seconds(rng.uniform(0, 1e6)); });
  const auto fill = [&](auto& list, std::size_t max_count, auto make) {
    list.resize(rng.below(max_count + 1));
    std::generate(list.begin(), list.end(), [&] { return make(rng); });
  };
  fill(detection.balls, 5, random_ball);
  fill(detection.yellow, 16, random_robot);
  fill(detection.blue, 16, random_robot);
  return detection;
}

inline CameraCalibration random_calibration(Rng& rng) {
  CameraCalibration camera;
  camera.camera = static_cast<std::uint32_t>(rng.below(kMaxCameras));
  camera.focal_length_px = rng.uniform(100, 2000);
  camera.principal_point_px = random_vec2(rng, 1000);
  camera.distortion = rng.uniform(0, 0.5);
  for (double& part : camera.rotation) part = rng.uniform(-1, 1);
  camera.translation_m = random_vec3(rng, 8);
  camera.position_m = maybe(rng, [&] { return random_vec3(rng, 8); });
  camera.image_width_px = maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(4000)); });
  camera.image_height_px = maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(4000)); });
  return camera;
}

inline Geometry random_geometry(Rng& rng) {
  // The wire format has whole millimetres.
  const auto length_m = [&] { return 0.001 * static_cast<double>(1 + rng.below(12000)); };
  Geometry geometry;
  FieldSize& field = geometry.field;
  field.length_m = length_m();
  field.width_m = length_m();
  field.goal_width_m = length_m();
  field.goal_depth_m = length_m();
  field.boundary_width_m = length_m();
  for (std::uint64_t i = rng.below(12); i > 0; --i) {
    field.lines.push_back({random_text(rng), random_vec2(rng, 6), random_vec2(rng, 6), rng.uniform(0, 0.02),
                           maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(14)); })});
  }
  for (std::uint64_t i = rng.below(3); i > 0; --i) {
    field.arcs.push_back({random_text(rng), random_vec2(rng, 6), rng.uniform(0, 1), rng.uniform(0, 3),
                          rng.uniform(3, 6.3), rng.uniform(0, 0.02),
                          maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(14)); })});
  }
  for (std::optional<double>* extra :
       {&field.penalty_area_depth_m, &field.penalty_area_width_m, &field.centre_circle_radius_m,
        &field.line_thickness_m, &field.goal_centre_to_penalty_mark_m, &field.goal_height_m,
        &field.ball_radius_m, &field.max_robot_radius_m}) {
    *extra = maybe(rng, length_m);
  }
  for (std::uint64_t i = rng.below(5); i > 0; --i) geometry.cameras.push_back(random_calibration(rng));
  return geometry;
}

inline VisionPacket random_vision_packet(Rng& rng) {
  VisionPacket packet;
  packet.geometry = maybe(rng, [&] { return random_geometry(rng); });
  if (!packet.geometry || rng.chance(0.5)) packet.detection = random_detection(rng);
  packet.source = maybe(rng, [&] { return static_cast<std::uint32_t>(rng.below(6)); });
  return packet;
}

inline TrackedPacket random_tracked_packet(Rng& rng) {
  TrackedPacket packet{random_text(rng), maybe(rng, [&] { return random_text(rng); }), std::nullopt};
  if (rng.chance(0.1)) return packet;
  TrackedFrame frame;
  frame.frame_number = random_u32(rng);
  frame.at = from_seconds(rng.uniform(0, 1.8e9));
  for (std::uint64_t i = rng.below(3); i > 0; --i) {
    TrackedBall ball;
    ball.position_m = random_vec3(rng, 10);
    ball.velocity_mps = maybe(rng, [&] { return random_vec3(rng, 8); });
    ball.visibility = maybe(rng, [&] { return rng.uniform(); });
    frame.balls.push_back(ball);
  }
  for (std::uint64_t i = rng.below(23); i > 0; --i) {
    TrackedRobot robot;
    robot.team = maybe(rng, [&] { return rng.chance(0.5) ? Team::kBlue : Team::kYellow; });
    robot.number = static_cast<std::uint32_t>(rng.below(kRobotNumbers));
    robot.position_m = random_vec2(rng, 10);
    robot.heading_rad = rng.uniform(-3.14, 3.14);
    robot.velocity_mps = maybe(rng, [&] { return random_vec2(rng, 4); });
    robot.angular_radps = maybe(rng, [&] { return rng.uniform(-10, 10); });
    robot.visibility = maybe(rng, [&] { return rng.uniform(); });
    frame.robots.push_back(robot);
  }
  packet.frame = frame;
  return packet;
}

inline RefereePacket random_referee_packet(Rng& rng) {
  RefereePacket packet;
  packet.sent = from_seconds(rng.uniform(0, 1.8e9));
  packet.command = static_cast<RefereeCommand>(rng.below(kRefereeCommands));
  packet.command_counter = random_u32(rng);
  packet.commanded = from_seconds(rng.uniform(0, 1.8e9));
  packet.designated_position_m = maybe(rng, [&] { return random_vec2(rng, 10); });
  return packet;
}

inline TeamCommands random_team_commands(Rng& rng) {
  TeamCommands packet;
  for (std::uint64_t i = 1 + rng.below(11); i > 0; --i) {
    RobotCommand robot;
    robot.number = static_cast<std::uint32_t>(rng.below(kRobotNumbers));
    robot.move = maybe(rng, [&] {
      return RobotMove{static_cast<RobotMove::Kind>(rng.below(3)), random_vec2(rng, 5), rng.uniform(-20, 20)};
    });
    robot.kick_mps = rng.uniform(0, 8);
    robot.kick_angle_rad = rng.uniform(0, 1);
    packet.robots.push_back(robot);
  }
  return packet;
}

inline SimulatorCommand random_simulator_command(Rng& rng) {
  SimulatorCommand packet;
  packet.ball = maybe(rng, [&] { return BallTeleport{random_vec2(rng, 5), random_vec2(rng, 5)}; });
  for (std::uint64_t i = rng.below(5); i > 0; --i) {
    RobotTeleport robot;
    robot.team = rng.chance(0.5) ? Team::kBlue : Team::kYellow;
    robot.number = static_cast<std::uint32_t>(rng.below(kRobotNumbers));
    robot.x_m = maybe(rng, [&] { return rng.uniform(-5, 5); });
    robot.y_m = maybe(rng, [&] { return rng.uniform(-5, 5); });
    robot.heading_rad = maybe(rng, [&] { return rng.uniform(-3, 3); });
    robot.is_present = maybe(rng, [&] { return rng.chance(0.5); });
    packet.robots.push_back(robot);
  }
  packet.speed = maybe(rng, [&] { return rng.uniform(0.1, 2); });
  packet.has_geometry = rng.chance(0.2);
  packet.has_robot_specs = rng.chance(0.2);
  return packet;
}

}  // namespace sidestep::league::test
