// SPDX-License-Identifier: Apache-2.0
#include "tests/study/camera/guided_drive.hpp"

#include <algorithm>
#include <numbers>

#include "agents/navigation/motion_control.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/world/body.hpp"

namespace sidestep {
namespace {

constexpr int kMaxFrames = 900, kFrame_steps = 33;  // steps of 1 ms
constexpr int kFirstEvent = 20, kEventSpan = 40, kSecondEventAfter = 70, kBumpFrames = 45;
constexpr MotionLimits kLimits{2, 3, 0.8};
constexpr double kArrival_m = 0.2, kTouched_m = 1e-6;

double length_of(const std::vector<Vec2>& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

/// The world of one drive: floor, body, cameras.
class DriveWorld {
 public:
  DriveWorld(DriveEvent event, std::uint64_t seed)
      : event_(event),
        rng_(seed),
        floor_(sample_camera_floor(rng_)),
        body_(floor_.start_m, rng_.uniform(-3, 3), BodySettings{}),
        renderer_(renderer_of(guiding_camera())),
        first_(kFirstEvent + static_cast<int>(rng_.below(kEventSpan))) {
    if (event != DriveEvent::kCameraBumped) return;
    const double angle_rad = rng_.uniform(0.5, 3) * std::numbers::pi / 180;
    bumped_renderer_.emplace(renderer_of(bumped(guiding_camera(), angle_rad, rng_)));
  }

  /// Carries out the event, if one is due before a frame.
  void happen(int frame) {
    const bool is_now = frame == first_ || frame == first_ + kSecondEventAfter;
    if (is_now && event_ == DriveEvent::kTargetMoves) floor_.target_m = sample_free_place(floor_, 0.35, rng_);
    if (is_now && event_ == DriveEvent::kRobotPushed) push();
  }
  bool is_bumped(int frame) const {
    return bumped_renderer_ && frame >= first_ && frame < first_ + kBumpFrames;
  }
  int first_event() const { return event_ == DriveEvent::kNone ? kMaxFrames : first_; }

  Image frame(int number) {
    SceneRobot robot;
    robot.position_m = body_.position_m();
    robot.heading_rad = body_.heading_rad();
    robot.velocity_mps = body_.velocity_mps();
    const Scene scene{{&robot, 1},
                      floor_.cylinders,
                      SceneBall{{floor_.target_m.x(), floor_.target_m.y(), RollingBall::kRadius_m}, {0, 0}}};
    return (is_bumped(number) ? *bumped_renderer_ : renderer_).render(scene);
  }

  Body& body() { return body_; }
  bool touches() const { return floor_.clearance_m(body_.position_m()) < kGuidedRadius_m - kTouched_m; }

 private:
  FrameRenderer renderer_of(const CameraModel& camera) {
    return {camera, kGuidedField, butterfly(), RenderSpec{}, Rng(rng_.bits()), floor_.statics};
  }

  /// Displaces the robot to a free place nearby.
  void push() {
    for (int i = 0; i < 100; ++i) {
      const double distance_m = rng_.uniform(0.1, 0.2), direction = rng_.uniform(-3.14, 3.14);
      const Vec2 shift_m = distance_m * rotated({1, 0}, direction), place_m = body_.position_m() + shift_m;
      if (floor_.clearance_m(place_m) < 0.2 || !kGuidedField.contains(place_m, 0.2)) continue;
      body_.displace(shift_m, {0, 0});
      return;
    }
  }

  DriveEvent event_;
  Rng rng_;
  CameraFloor floor_;
  Body body_;
  FrameRenderer renderer_;
  std::optional<FrameRenderer> bumped_renderer_;
  int first_;
};

Vec2 braking(const Vec2& velocity_mps) {
  const double speed_mps = velocity_mps.norm();
  if (speed_mps == 0) return {0, 0};
  return -std::min(kLimits.deceleration_mps2, speed_mps / 0.02) / speed_mps * velocity_mps;
}

/// Drives towards the carrot, or brakes, until the next frame. Uses the position seen by the camera, advanced
/// by odometry.
void step_body(DriveWorld& world, const PixelGuide::Guidance& guidance, DriveResult& result) {
  Body& body = world.body();
  const Vec2 rolled_m = body.rolled_position_m();
  for (int step = 0; step < kFrame_steps; ++step) {
    Actuation actuation;
    if (guidance.carrot_m) {
      const Vec2 here_m = *guidance.robot_m + body.rolled_position_m() - rolled_m;
      actuation.acceleration_mps2 = desired_acceleration(*guidance.carrot_m - here_m, body.velocity_mps(),
                                                         kLimits, kPhysicsStep, 50 * kPhysicsStep)
                                        .acceleration_mps2;
    } else {
      actuation.acceleration_mps2 = braking(body.velocity_mps());
    }
    body.step(actuation);
    result.contacts += world.touches() ? 1 : 0;
  }
}

void count(const PixelGuide::Guidance& guidance, int frame, const DriveWorld& world, DriveResult& result) {
  if (guidance.replanned != ReplanReason::kNone && guidance.replanned != ReplanReason::kNoPath) {
    ++result.replans;
    result.unnecessary_replans += frame < world.first_event() ? 1 : 0;
  }
  if (guidance.camera_is_known) return;
  if (world.is_bumped(frame) && !result.noticed_after_frames)
    result.noticed_after_frames = frame - world.first_event() + 1;
  // After an event, a lost camera is no false alarm: a bumped camera counts as known again only after some
  // good frames.
  const bool is_returning = frame >= world.first_event();
  result.false_alarms += is_returning ? 0 : 1;
}

}  // namespace

DriveResult drive(DriveEvent event, PixelPlanner planner, std::uint64_t seed) {
  DriveWorld world(event, seed);
  PixelGuide guide(guiding_camera(), kGuidedField, planner);
  DriveResult result;
  for (int frame = 0; frame < kMaxFrames; ++frame) {
    world.happen(frame);
    const Image image = world.frame(frame);
    const PixelGuide::Guidance guidance = guide.guide(image.view());
    count(guidance, frame, world, result);
    if (frame == 0) {
      const PixelPaths paths = guide.plan_all();
      result.cells_px = length_of(paths[0]);
      result.diamonds_px = length_of(paths[1]);
      result.discs_px = length_of(paths[2]);
    }
    result.frames = frame + 1;
    // A drive with events does not end before the last event.
    const bool all_happened = event == DriveEvent::kNone || frame > world.first_event() + kSecondEventAfter;
    if (guidance.carrot_m && guidance.to_target_m < kArrival_m && all_happened) {
      result.arrived = true;
      break;
    }
    const Vec2 before_m = world.body().position_m();
    step_body(world, guidance, result);
    if (world.is_bumped(frame)) result.blind_m += (world.body().position_m() - before_m).norm();
  }
  result.times = guide.times();
  return result;
}

}  // namespace sidestep
