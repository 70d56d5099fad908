// SPDX-License-Identifier: Apache-2.0
#include "simulator/league/league_frames.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "common/motion/rolling_ball.hpp"
#include "simulator/league/league_geometry.hpp"

namespace sidestep {
namespace {

constexpr double kRobotHeight_m = 0.15;
constexpr std::uint32_t kSourceOther = 1;

/// The pixel of a detection. Noise can move a detection out of the image but never behind the camera.
Vec2 pixel_of(const Vec2& position_m, double height_m, const CameraModel& camera) {
  return camera.pixel_of({position_m.x(), position_m.y(), height_m}).value_or(Vec2(0, 0));
}

league::DetectedRobot detected_robot(const Vec2& position_m, const CameraModel& camera) {
  league::DetectedRobot detected;
  detected.position_m = position_m;
  detected.height_m = kRobotHeight_m;
  detected.pixel = pixel_of(position_m, kRobotHeight_m, camera);
  return detected;
}

}  // namespace

LeagueFrames::LeagueFrames(const Scenario& scenario, std::span<const CameraView> views)
    : scenario_(scenario), frame_numbers_(views.size()) {
  require_unique_numbers(scenario);
  if (views.size() > league::kMaxCameras) {
    throw std::invalid_argument(
        fmt::format("{} cameras, expected at most {} in the league", views.size(), league::kMaxCameras));
  }
  for (const CameraView& view : views) cameras_.push_back(league_camera(view));
}

league::VisionPacket LeagueFrames::detection(const msg::DetectionFrame& frame, Time now) {
  const CameraModel& camera = cameras_.at(frame.camera());
  league::DetectionFrame detection;
  detection.frame_number = ++frame_numbers_[frame.camera()];
  detection.camera = frame.camera();
  detection.captured = Duration{frame.captured_at_ns()};
  detection.sent = now.time_since_epoch();
  for (const msg::RobotDetection& robot : frame.robots()) add(robot, camera, detection);
  for (std::size_t i = 0; i < frame.obstacle_count(); ++i) {
    const msg::ObstacleDetection& opponent = frame.obstacles()[i];
    detection.yellow.push_back(detected_robot({opponent.x_m(), opponent.y_m()}, camera));
    detection.yellow.back().confidence = 1;
  }
  for (std::size_t i = 0; i < frame.ball_count(); ++i) {
    const msg::BallDetection& ball = frame.balls()[i];
    league::DetectedBall detected;
    detected.position_m = {ball.x_m(), ball.y_m()};
    detected.confidence = ball.confidence();
    detected.pixel = pixel_of(detected.position_m, RollingBall::kRadius_m, camera);
    detection.balls.push_back(detected);
  }
  return {std::move(detection), std::nullopt, kSourceOther};
}

void LeagueFrames::add(const msg::RobotDetection& robot, const CameraModel& camera,
                       league::DetectionFrame& detection) const {
  league::DetectedRobot detected = detected_robot({robot.x_m(), robot.y_m()}, camera);
  detected.number = number_in_team(robot.robot());
  detected.heading_rad = robot.heading_rad();
  detected.confidence = robot.confidence();
  // A ghost's id may belong to no robot of the scenario; such a ghost counts as blue.
  const RobotSpec* const spec = find_robot(scenario_, robot.robot());
  const bool is_yellow = spec && spec->team == Team::kYellow;
  (is_yellow ? detection.yellow : detection.blue).push_back(detected);
}

league::VisionPacket LeagueFrames::geometry() const {
  league::Geometry geometry{league_field(scenario_.field), {}};
  for (const CameraModel& camera : cameras_) {
    geometry.cameras.push_back(calibration_of(camera, static_cast<std::uint32_t>(geometry.cameras.size())));
  }
  return {std::nullopt, std::move(geometry), kSourceOther};
}

}  // namespace sidestep
