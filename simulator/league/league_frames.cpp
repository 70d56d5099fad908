// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_frames.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "simulator/league/league_geometry.hpp"

namespace sidestep {
namespace {

constexpr double kRobotHeight_m = 0.15;
constexpr double kBallRadius_m = 0.0215;
constexpr std::uint32_t kSourceOther = 1;

/// Noise may move a detection out of the image, but never behind the camera.
Vec2 pixel_of(const Vec2& position_m, double height_m, const CameraModel& camera) {
  return camera.pixel_of({position_m.x(), position_m.y(), height_m}).value_or(Vec2(0, 0));
}

league::SeenRobot seen_at(const Vec2& position_m, const CameraModel& camera) {
  league::SeenRobot seen;
  seen.position_m = position_m;
  seen.height_m = kRobotHeight_m;
  seen.pixel = pixel_of(position_m, kRobotHeight_m, camera);
  return seen;
}

}  // namespace

LeagueFrames::LeagueFrames(const Scenario& scenario, std::span<const CameraView> views)
    : scenario_(scenario), frame_numbers_(views.size()) {
  require_own_numbers(scenario);
  if (views.size() > league::kMaxCameras) {
    throw std::invalid_argument(
        fmt::format("{} cameras, expected at most {} in the league", views.size(), league::kMaxCameras));
  }
  for (const CameraView& view : views) cameras_.push_back(league_camera(view));
}

league::VisionPacket LeagueFrames::detection(const msg::DetectionFrame& frame, Time now) {
  const CameraModel& camera = cameras_.at(frame.camera());
  league::Detection detection;
  detection.frame_number = ++frame_numbers_[frame.camera()];
  detection.camera = frame.camera();
  detection.captured = Duration{frame.captured_at_ns()};
  detection.sent = now.time_since_epoch();
  for (const msg::RobotDetection& robot : frame.robots()) add(robot, camera, detection);
  for (std::size_t i = 0; i < frame.obstacle_count(); ++i) {
    const msg::ObstacleDetection& opponent = frame.obstacles()[i];
    detection.yellow.push_back(seen_at({opponent.x_m(), opponent.y_m()}, camera));
    detection.yellow.back().confidence = 1;
  }
  for (std::size_t i = 0; i < frame.ball_count(); ++i) {
    const msg::BallDetection& ball = frame.balls()[i];
    league::SeenBall seen;
    seen.position_m = {ball.x_m(), ball.y_m()};
    seen.confidence = ball.confidence();
    seen.pixel = pixel_of(seen.position_m, kBallRadius_m, camera);
    detection.balls.push_back(seen);
  }
  return {std::move(detection), std::nullopt, kSourceOther};
}

void LeagueFrames::add(const msg::RobotDetection& robot, const CameraModel& camera,
                       league::Detection& detection) const {
  league::SeenRobot seen = seen_at({robot.x_m(), robot.y_m()}, camera);
  seen.number = number_of(robot.robot());
  seen.heading_rad = robot.heading_rad();
  seen.confidence = robot.confidence();
  // A ghost may be of a robot that does not exist; it is taken for blue.
  const RobotSpec* const spec = find_robot(scenario_, robot.robot());
  const bool is_yellow = spec && spec->team == Team::kYellow;
  (is_yellow ? detection.yellow : detection.blue).push_back(seen);
}

league::VisionPacket LeagueFrames::geometry() const {
  league::Geometry geometry{league_field(scenario_.field), {}};
  for (const CameraModel& camera : cameras_) {
    geometry.cameras.push_back(calibration_of(camera, static_cast<std::uint32_t>(geometry.cameras.size())));
  }
  return {std::nullopt, std::move(geometry), kSourceOther};
}

}  // namespace sidestep
