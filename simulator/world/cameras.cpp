// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/cameras.hpp"

#include <algorithm>

#include "common/messaging/detected_obstacles.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {
namespace {

constexpr double kMinRadius_m = 0.001;
constexpr double kMaxGhostRadius_m = 0.2;
// Slightly below pi, so that no heading wraps.
constexpr double kMaxGhostHeading_rad = 3.14159265358979;

/// The direction of a position from the field's centre; zero at the centre.
Vec2 direction_of(const Vec2& position_m) {
  constexpr double kAtCentre_m = 1e-6;
  return position_m.norm() > kAtCentre_m ? Vec2(position_m.normalized()) : Vec2(0, 0);
}

double confidence(Rng& rng) { return rng.uniform(0.8, 1.0); }

}  // namespace

Cameras::Cameras(const Scenario& scenario, Time begin, std::uint64_t seed, double outward_error_m)
    : spec_(scenario.vision), period_(from_seconds(1 / scenario.vision.rate_hz)), rng_(seed) {
  for (const RobotSpec& robot : scenario.robots) ids_.push_back(robot.id);
  const Vec2 corner(-scenario.field.length_m / 2, -scenario.field.width_m / 2);
  const Vec2 share(scenario.field.length_m / spec_.columns, scenario.field.width_m / spec_.rows);
  const Vec2 overlap = Vec2::Constant(spec_.overlap_m);
  const int count = spec_.columns * spec_.rows;
  for (int camera = 0; camera < count; ++camera) {
    const Vec2 low = corner + share.cwiseProduct(Vec2(camera % spec_.columns, camera / spec_.columns));
    views_.push_back({low - overlap, low + share + overlap});
    errors_m_.push_back(outward_error_m * direction_of(low + share / 2));
    due_.push_back(begin + period_ * (camera + 1) / count);
  }
}

void Cameras::select_next_camera() {
  next_ = static_cast<std::size_t>(std::min_element(due_.begin(), due_.end()) - due_.begin());
}

void Cameras::capture(Time now, const VisibleObjects& objects, msg::DetectionFrame& frame) {
  const std::span<const Body> robots = objects.robots;
  const Vec2* const ball_m = objects.ball_m;
  const std::size_t camera = next_;
  const CameraView& view = views_[camera];
  do {
    due_[camera] += period_;
  } while (due_[camera] <= now);
  select_next_camera();

  frame.camera(static_cast<std::uint32_t>(camera));
  frame.captured_at_ns(to_ns(now));
  frame.robots().clear();
  for (std::size_t i = 0; i < robots.size(); ++i)
    detect_robot(i, robots[i], objects.vision_faults.empty() ? VisionFault() : objects.vision_faults[i], view,
                 frame);
  if (rng_.chance(spec_.ghost_probability) && frame.robots().size() < topics::kDetections.type.max_elements) {
    add_ghost(view, frame);
  }

  frame.ball_count(0);
  if (ball_m && view.sees(*ball_m) && !rng_.chance(spec_.miss_probability)) {
    msg::BallDetection& seen = frame.balls()[0];
    seen.x_m(ball_m->x() + spec_.position_noise_m * rng_.normal());
    seen.y_m(ball_m->y() + spec_.position_noise_m * rng_.normal());
    seen.confidence(confidence(rng_));
    frame.ball_count(1);
  }
  detect_opponents(view, objects.opponents, frame);
  if (!errors_m_[camera].isZero(0)) displace(errors_m_[camera], frame);
}

void Cameras::displace(const Vec2& error_m, msg::DetectionFrame& frame) {
  const auto shift = [&](auto& seen) {
    seen.x_m(seen.x_m() + error_m.x());
    seen.y_m(seen.y_m() + error_m.y());
  };
  for (msg::RobotDetection& robot : frame.robots()) shift(robot);
  for (std::size_t i = 0; i < frame.ball_count(); ++i) shift(frame.balls()[i]);
  for (std::size_t i = 0; i < frame.obstacle_count(); ++i) shift(frame.obstacles()[i]);
}

void Cameras::detect_robot(std::size_t robot, const Body& body, const VisionFault& error,
                           const CameraView& view, msg::DetectionFrame& frame) {
  if (!body.is_on_floor()) return;
  VisionFault::Pose pose = error.frozen.value_or(VisionFault::Pose{body.position_m(), body.heading_rad()});
  pose.position_m += error.offset_m;
  if (!view.sees(pose.position_m) || rng_.chance(spec_.miss_probability)) return;
  msg::RobotDetection seen;
  seen.robot(ids_[error.shown_as.value_or(robot)]);
  seen.x_m(pose.position_m.x() + spec_.position_noise_m * rng_.normal());
  seen.y_m(pose.position_m.y() + spec_.position_noise_m * rng_.normal());
  seen.heading_rad(wrapped_rad(pose.heading_rad + spec_.heading_noise_rad * rng_.normal()));
  seen.confidence(confidence(rng_));
  frame.robots().push_back(seen);
}

void Cameras::detect_opponents(const CameraView& view, std::span<const Circle> opponents,
                               msg::DetectionFrame& frame) {
  seen_opponents_.clear();
  for (const Circle& opponent : opponents) {
    if (!view.sees(opponent.centre_m) || rng_.chance(spec_.miss_probability)) continue;
    const double x = opponent.centre_m.x() + spec_.position_noise_m * rng_.normal();
    const double y = opponent.centre_m.y() + spec_.position_noise_m * rng_.normal();
    const double radius = opponent.radius_m + spec_.position_noise_m * rng_.normal();
    seen_opponents_.push_back({{x, y}, std::max(kMinRadius_m, radius)});
  }
  if (spec_.ghost_obstacle_probability > 0 && rng_.chance(spec_.ghost_obstacle_probability)) {
    const double x = rng_.uniform(view.low_m.x(), view.high_m.x());
    const double y = rng_.uniform(view.low_m.y(), view.high_m.y());
    seen_opponents_.push_back({{x, y}, rng_.uniform(kMinRadius_m, kMaxGhostRadius_m)});
  }
  set_obstacles(seen_opponents_, frame);
}

void Cameras::add_ghost(const CameraView& view, msg::DetectionFrame& frame) {
  msg::RobotDetection ghost;
  // Half of the ghosts have the id of an existing robot, which makes them harder to reject.
  const bool is_known = !ids_.empty() && rng_.chance(0.5);
  ghost.robot(is_known ? ids_[rng_.below(ids_.size())] : static_cast<RobotId>(rng_.below(kMaxRobots)));
  ghost.x_m(rng_.uniform(view.low_m.x(), view.high_m.x()));
  ghost.y_m(rng_.uniform(view.low_m.y(), view.high_m.y()));
  ghost.heading_rad(rng_.uniform(-kMaxGhostHeading_rad, kMaxGhostHeading_rad));
  ghost.confidence(confidence(rng_));
  frame.robots().push_back(ghost);
}

}  // namespace sidestep
