// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_event_logger.hpp"

namespace sidestep {

VisionEventLogger::VisionEventLogger(const EventReporter& events, const std::vector<std::uint32_t>& cameras)
    : events_(events) {
  for (const std::uint32_t camera : cameras) cameras_.emplace(camera, Camera{});
}

void VisionEventLogger::on_unknown_camera(std::uint32_t camera) {
  if (++unknown_ < next_unknown_report_) return;
  next_unknown_report_ *= 10;
  events_.report(LogLevel::kWarning, {},
                 "{} frame(s) of unconfigured cameras refused so far; the latest was from camera {}",
                 unknown_, camera);
}

void VisionEventLogger::report_missing(std::uint32_t number, Camera& camera, Time now) {
  if (camera.is_missing || now - *begin_ < kFirstFrameTimeout) return;
  camera.is_missing = true;
  events_.report(LogLevel::kWarning, {},
                 "camera {} has sent no usable frame so far: obstacles in its view may be missed", number);
}

void VisionEventLogger::on_frame(const Frame& frame, Time now) {
  Camera& camera = cameras_.at(frame.camera());
  if (!frame.is_usable()) return report_refusal(frame, camera, now);
  if (camera.heard_at == Time{})
    events_.report(LogLevel::kDebug, {}, "camera {} has started to send frames", frame.camera());
  else if (camera.is_lost)
    events_.report(LogLevel::kInfo, {}, "camera {} is back, after {:.1f} s", frame.camera(),
                   to_seconds(now - camera.heard_at));
  camera.heard_at = now;
  camera.is_lost = false;
}

void VisionEventLogger::report_refusal(const Frame& frame, Camera& camera, Time now) {
  if (++camera.refused < camera.next_report) return;
  camera.next_report *= 10;
  if (frame.problem() == FrameProblem::kTime)
    events_.report(LogLevel::kWarning, {},
                   "camera {}: {} frame(s) refused so far: the clock of the camera is wrong, or the frame is "
                   "old; the latest was captured {:.3f} s before it arrived",
                   frame.camera(), camera.refused, to_seconds(now - frame.captured_at()));
  else
    events_.report(LogLevel::kWarning, {}, "camera {}: {} frame(s) refused so far: malformed", frame.camera(),
                   camera.refused);
}

void VisionEventLogger::update(const msg::WorldState& world, Time now) {
  if (!begin_) begin_ = now;
  for (auto& [number, camera] : cameras_) {
    if (camera.heard_at == Time{}) report_missing(number, camera, now);
    if (camera.is_lost || camera.heard_at == Time{} || now - camera.heard_at <= kCameraTimeout) continue;
    camera.is_lost = true;
    events_.report(LogLevel::kWarning, {}, "camera {} is lost: no usable frame for {:.1f} s", number,
                   to_seconds(now - camera.heard_at));
  }
  is_tracked_.fill(false);
  for (const msg::TrackedRobot& tracked : world.robots()) {
    const RobotId robot = tracked.robot();
    is_tracked_[robot] = true;
    if (was_lost_[robot]) events_.report(LogLevel::kInfo, robot, "robot {} is seen again", robot);
    was_lost_[robot] = false;
  }
  for (RobotId robot = 0; robot < kMaxRobots; ++robot) {
    if (!was_tracked_[robot] || is_tracked_[robot]) continue;
    was_lost_[robot] = true;
    events_.report(LogLevel::kWarning, robot, "robot {} is lost: no camera sees it", robot);
  }
  was_tracked_ = is_tracked_;
}

}  // namespace sidestep
