// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "common/marking/pose_error.hpp"
#include "vision/tracking/camera_watch.hpp"

namespace sidestep {
namespace {

void fill(msg::TrackedRobot& robot, const Estimate& estimate, const Observation& observation) {
  robot.x_m(estimate.position_m.x());
  robot.y_m(estimate.position_m.y());
  robot.heading_rad(estimate.heading_rad);
  robot.vx_mps(estimate.velocity_mps.x());
  robot.vy_mps(estimate.velocity_mps.y());
  robot.angular_radps(estimate.angular_radps);
  robot.position_variance_m2(estimate.position_variance_m2);
  robot.velocity_variance_m2ps2(estimate.velocity_variance_m2ps2);
  robot.observed_at_ns(to_ns(observation.captured_at));
  robot.observed_x_m(observation.position_m.x());
  robot.observed_y_m(observation.position_m.y());
  robot.observed_heading_rad(observation.heading_rad);
}

msg::TrackedBall tracked_ball(const State& state) {
  msg::TrackedBall ball;
  ball.is_visible(true);
  ball.x_m(state.position_m.x());
  ball.y_m(state.position_m.y());
  ball.vx_mps(state.velocity_mps.x());
  ball.vy_mps(state.velocity_mps.y());
  return ball;
}

constexpr double kDotError_px =
    0.19;  // error of a single dot's position in images, measured by sidestep-evaluation study vision
constexpr double kRobotHeight_m = 0.15;  // height of the dots
// Error of an obstacle's position: cameras observe its contour from different sides, and thresholds affect
// its edge.
constexpr double kContourError_m = 0.008;

void set_image_noise(const Scenario& scenario, TrackModel& robot) {
  const CameraModel camera = camera_grid(scenario).front();
  const Vec3 below_m(camera.position_m().x(), camera.position_m().y(), kRobotHeight_m);
  const double px2_per_m2 = std::abs(camera.projection_jacobian(below_m)->leftCols<2>().determinant());
  const PoseError error = predicted_pose_error(butterfly(), kDotError_px / std::sqrt(px2_per_m2));
  robot.position_noise_m = std::max(error.longitudinal_m, error.lateral_m);
  robot.heading_noise_rad = error.heading_rad;
}

}  // namespace

TrackModel TrackerSettings::ball_model() {
  TrackModel ball;
  ball.motion = {1, 1};
  ball.rolling_mps2 = RollingBall::kFriction_mps2;
  ball.start_speed_mps = 4;
  ball.gate_m = 0.5;
  ball.relocate_after = Duration{30'000'000};
  ball.drop_after = Duration{500'000'000};
  return ball;
}

TrackerSettings tracker_settings(const Scenario& scenario) {
  // Lower bounds of the noise, so that gates are not infinitely narrow in a scenario without noise.
  constexpr double kMinPositionNoise_m = 0.0002, kMinHeadingNoise_rad = 0.002;
  TrackerSettings settings;
  settings.robot.position_noise_m = std::max(kMinPositionNoise_m, scenario.vision.position_noise_m);
  settings.robot.heading_noise_rad = std::max(kMinHeadingNoise_rad, scenario.vision.heading_noise_rad);
  if (scenario.vision.images) set_image_noise(scenario, settings.robot);
  settings.robot.gate_m = scenario.radius_m;
  // With slow cameras, consecutive frames must be within max_gap for a track to be confirmed.
  const Duration between_frames = from_seconds(1.5 / scenario.vision.rate_hz);
  settings.robot.max_gap = settings.ball.max_gap =
      std::clamp(between_frames, settings.robot.max_gap, CameraWatch::kMaxGap);
  settings.ball.position_noise_m = settings.robot.position_noise_m;
  settings.obstacles.position_noise_m =
      scenario.vision.images ? kContourError_m : settings.robot.position_noise_m;
  settings.obstacles.max_speed_mps = scenario.max_opponent_speed_mps;
  settings.field = scenario.field;
  settings.floor_obstacles = scenario.obstacles;
  settings.map = scenario.map;
  settings.robot_radius_m = scenario.radius_m;
  settings.max_date_error_m = vision_error_bound_m(scenario.tracking_bound_m);
  return settings;
}

Tracker::Tracker(const TrackerSettings& settings, std::span<const RobotId> roster)
    : settings_(settings),
      configured_noise_m_(settings.robot.position_noise_m),
      roster_(roster.begin(), roster.end()),
      robots_(roster.size()),
      obstacles_(settings.obstacles) {
  std::sort(roster_.begin(), roster_.end());
  index_of_.fill(kNotInRoster);
  for (std::size_t i = 0; i < roster_.size(); ++i) index_of_.at(roster_[i]) = static_cast<std::uint16_t>(i);
}

void Tracker::update(const Frame& frame) {
  if (!frame.is_usable()) {
    ++(frame.problem() == FrameProblem::kTime ? untimely_frames_ : malformed_frames_);
    return;
  }
  malformed_ += frame.rejected();
  bool is_new = frame.robots().empty() && frame.balls().empty();
  for (const RobotPoseObservation& robot : frame.robots()) {
    const std::uint16_t index = index_of_[robot.robot];
    if (index == kNotInRoster) {
      ++unknown_;
      continue;
    }
    if (is_misplaced(frame, robots_[index].state())) {
      ++misplaced_;
      continue;
    }
    const Observation observation{frame.captured_at(), frame.camera(), robot.position_m, robot.heading_rad,
                                  frame.date_uncertainty()};
    is_new |= robots_[index].add(observation, settings_.robot);
  }
  for (const Vec2& position_m : frame.balls()) {
    is_new |= ball_.add({frame.captured_at(), frame.camera(), position_m, 0, frame.date_uncertainty()},
                        settings_.ball);
  }
  obstacles_.update(frame);
  frames_ += is_new ? 1 : 0;
}

bool Tracker::is_misplaced(const Frame& frame, const TrackState& robot) const {
  // This much varies from frame to frame, and the filters of vision and robots average it out.
  constexpr Duration kAveraged{3'000'000};
  if (!robot.is_confirmed || frame.date_uncertainty() <= kAveraged) return false;
  const double speed_mps = robot.filter.position.velocity().norm();
  // The comparison is false for NaN.
  return !(speed_mps * to_seconds(frame.date_uncertainty() - kAveraged) <= settings_.max_date_error_m);
}

void Tracker::set_camera_error(double position_error_m) {
  settings_.robot.position_noise_m = std::max(configured_noise_m_, position_error_m);
  obstacles_.set_camera_error(position_error_m);
}

void Tracker::forget() {
  robots_.assign(robots_.size(), Track());
  ball_ = Track();
  obstacles_.forget();
}

void Tracker::count_drops(DropCounters& drops) const {
  drops.count(DropReason::kUntimelyFrame, std::nullopt, untimely_frames_);
  drops.count(DropReason::kMalformedFrame, std::nullopt, malformed_frames_);
  drops.count(DropReason::kMalformedDetection, std::nullopt, malformed_);
  drops.count(DropReason::kUnknownRobot, std::nullopt, unknown_);
  drops.count(DropReason::kUnusedLeagueDetection, std::nullopt, misplaced_);
  drops.count(DropReason::kTooManyObstacles, std::nullopt, obstacles_.rejected());
  drops.count(DropReason::kFalseDetection, std::nullopt, ball_.rejected());
  for (std::size_t i = 0; i < robots_.size(); ++i)
    drops.count(DropReason::kFalseDetection, roster_[i], robots_[i].rejected());
}

void Tracker::world_at(Time t, msg::WorldState& world) const {
  std::size_t count = 0;
  world.robots().resize(roster_.size());
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    const TrackState& state = robots_[i].state();
    if (const auto estimate = estimate_at(state, t, settings_.robot)) {
      msg::TrackedRobot& robot = world.robots()[count++];
      robot.robot(roster_[i]);
      fill(robot, *estimate, state.last);
      robot.is_seen_elsewhere(is_seen_elsewhere(state, settings_.robot));
    }
  }
  world.robots().resize(count);
  world.valid_at_ns(to_ns(t));
  world.frames(frames_);
  const bool is_tracked = estimate_at(ball_.state(), t, settings_.ball).has_value();
  world.ball(is_tracked ? tracked_ball(ball_at(t, world)) : msg::TrackedBall());
}

void Tracker::obstacles_at(const msg::WorldState& world, msg::ObstacleList& list) {
  obstacles_.list_at(time_from_ns(world.valid_at_ns()), world.robots(), list);
}

/// Precondition: `world` contains the robots at time `t`.
State Tracker::ball_at(Time t, const msg::WorldState& world) const {
  constexpr double kStep_s = 0.005;
  const TrackState& track = ball_.state();
  RollingBall ball({track.filter.position.position(), track.filter.position.velocity()});
  double remaining_s = to_seconds(t - track.last.captured_at);
  while (remaining_s > 0) {
    const double step_s = std::min(remaining_s, kStep_s);
    remaining_s -= step_s;
    ball.roll(step_s);
    for (const Shape& obstacle : settings_.floor_obstacles) ball.bounce_off(obstacle);
    if (settings_.map) ball.bounce_off(*settings_.map);
    for (const msg::TrackedRobot& robot : world.robots()) {
      const Vec2 velocity_mps(robot.vx_mps(), robot.vy_mps());
      const Vec2 position_m = Vec2(robot.x_m(), robot.y_m()) - remaining_s * velocity_mps;
      ball.bounce_off_robot({position_m, settings_.robot_radius_m}, velocity_mps);
    }
    ball.bounce_off_walls(settings_.field);
  }
  return ball.state();
}

}  // namespace sidestep
