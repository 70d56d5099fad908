// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "common/protocol/obstacle_bounds.hpp"
#include "common/random/rng.hpp"
#include "tests/drops.hpp"
#include "tests/unit/common/random/normal_vector.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep::test {

inline constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
inline constexpr Duration kFrame{16'666'667};
inline constexpr Duration kMs{1'000'000};

inline Time after_s(double s) { return kBegin + from_seconds(s); }

struct Pose {
  Vec2 position_m{0, 0};
  Vec2 velocity_mps{0, 0};
  double heading_rad = 0;
};

/// Ground truth of a motion at every millisecond.
class TrueMotion {
 public:
  /// Constant acceleration from an initial pose.
  static TrueMotion accelerating(Pose pose, const Vec2& acceleration_mps2, double turn_radps,
                                 double duration_s) {
    TrueMotion motion;
    for (double t = 0; t <= duration_s; t += 0.001) {
      motion.poses_.push_back({pose.position_m + pose.velocity_mps * t + acceleration_mps2 * (t * t / 2),
                               pose.velocity_mps + acceleration_mps2 * t, pose.heading_rad + turn_radps * t});
    }
    return motion;
  }

  /// A robot that changes its acceleration, up to 5 m/s², every 50 to 400 ms, at speeds of up to 2 m/s.
  static TrueMotion driving(Rng& rng, double duration_s) {
    TrueMotion motion;
    Pose pose;
    Vec2 acceleration{0, 0};
    double turn_radps = 0, until = 0;
    for (double t = 0; t <= duration_s; t += 0.001) {
      if (t >= until) {
        const double angle_rad = rng.uniform(0, 6.28);
        const Vec2 target = rotated({rng.uniform(0, 2), 0}, angle_rad);
        acceleration = (target - pose.velocity_mps).normalized() * rng.uniform(0, 5);
        turn_radps = std::clamp(turn_radps + rng.uniform(-1, 1), -3.0, 3.0);
        until = t + rng.uniform(0.05, 0.4);
      }
      motion.poses_.push_back(pose);
      if ((pose.velocity_mps + acceleration * 0.001).norm() > 2) acceleration.setZero();
      pose.position_m += pose.velocity_mps * 0.001 + acceleration * 0.5e-6;
      pose.velocity_mps += acceleration * 0.001;
      pose.heading_rad += turn_radps * 0.001;
    }
    return motion;
  }

  Pose at(Time t) const {
    const double ms = std::clamp(to_seconds(t - kBegin) * 1e3, 0.0, static_cast<double>(poses_.size() - 1));
    const Pose& pose = poses_[static_cast<std::size_t>(ms)];
    const double rest_s = (ms - std::floor(ms)) * 1e-3;
    return {pose.position_m + pose.velocity_mps * rest_s, pose.velocity_mps, pose.heading_rad};
  }

 private:
  std::vector<Pose> poses_;
};

struct CameraNoise {
  double position_m = 0.0015;
  double heading_rad = 0.005;
};

inline msg::DetectionFrame frame_message(std::uint32_t camera, Time captured_at) {
  msg::DetectionFrame frame;
  frame.camera(camera);
  frame.captured_at_ns(to_ns(captured_at));
  frame.ball_count(0);
  frame.obstacles_complete_within_m(kCompleteEverywhere_m);
  return frame;
}

inline void add_robot(msg::DetectionFrame& frame, RobotId id, const Vec2& position_m,
                      double heading_rad = 0) {
  msg::RobotDetection d;
  d.robot(id);
  d.x_m(position_m.x());
  d.y_m(position_m.y());
  d.heading_rad(wrapped_rad(heading_rad));
  d.confidence(1);
  frame.robots().push_back(d);
}

inline void add_obstacle(msg::DetectionFrame& frame, const Vec2& position_m, double radius_m = 0.1) {
  auto& d = frame.obstacles().at(frame.obstacle_count());
  d.x_m(position_m.x());
  d.y_m(position_m.y());
  d.radius_m(radius_m);
  frame.obstacle_count(static_cast<std::uint16_t>(frame.obstacle_count() + 1));
}

inline void add_ball(msg::DetectionFrame& frame, const Vec2& position_m) {
  auto& d = frame.balls()[frame.ball_count()];
  d.x_m(position_m.x());
  d.y_m(position_m.y());
  d.confidence(1);
  frame.ball_count(static_cast<std::uint8_t>(frame.ball_count() + 1));
}

inline void add_noisy_robot(msg::DetectionFrame& frame, RobotId id, const Pose& pose,
                            const CameraNoise& noise, Rng& rng) {
  const double heading_rad = pose.heading_rad + noise.heading_rad * rng.normal();
  add_robot(frame, id, pose.position_m + noise.position_m * normal_vector(rng), heading_rad);
}

/// A tracker for robots 0 to count - 1 that receives messages.
class TrackerFixture {
 public:
  explicit TrackerFixture(RobotId count, const TrackerSettings& settings = {})
      : tracker_(settings, roster(count)) {}

  void feed(const msg::DetectionFrame& message, Time arrival, Duration date_uncertainty = Duration{0}) {
    frame_.assign(message, arrival, kMaxFrameLead, date_uncertainty);
    tracker_.update(frame_);
  }
  /// The message arrives at its time of capture.
  void feed(const msg::DetectionFrame& message) { feed(message, time_from_ns(message.captured_at_ns())); }

  const msg::WorldState& world_at(Time t) {
    tracker_.world_at(t, world_);
    return world_;
  }
  const msg::ObstacleList& obstacles_at(Time t) {
    tracker_.obstacles_at(world_at(t), list_);
    return list_;
  }
  void set_camera_error(double position_error_m) { tracker_.set_camera_error(position_error_m); }
  /// Number of rejected detections.
  std::uint64_t rejected() const { return drops_of(tracker_).total(); }
  /// The robot's entry in the world state at a time, or nullptr.
  const msg::TrackedRobot* robot_at(RobotId id, Time t) {
    for (const auto& robot : world_at(t).robots()) {
      if (robot.robot() == id) return &robot;
    }
    return nullptr;
  }

 private:
  static std::vector<RobotId> roster(RobotId count) {
    std::vector<RobotId> ids(count);
    std::iota(ids.begin(), ids.end(), RobotId{0});
    return ids;
  }
  Tracker tracker_;
  Frame frame_;
  msg::WorldState world_;
  msg::ObstacleList list_;
};

inline Vec2 position_of(const msg::TrackedRobot& r) { return {r.x_m(), r.y_m()}; }
inline Vec2 velocity_of(const msg::TrackedRobot& r) { return {r.vx_mps(), r.vy_mps()}; }
inline Vec2 observed_position_of(const msg::TrackedRobot& r) { return {r.observed_x_m(), r.observed_y_m()}; }

}  // namespace sidestep::test
