// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_changes.hpp"

namespace sidestep {

void VisionChanges::on_frame(const Frame& frame, Time now) {
  const auto found = cameras_.find(frame.camera());
  if (found == cameras_.end() && cameras_.size() >= kMaxCameras) return;
  Camera& camera = cameras_[frame.camera()];
  if (!frame.is_usable()) return report_refusal(frame, camera, now);
  if (camera.heard_at == Time{})
    events_.report(LogLevel::kDebug, {}, "camera {} sends frames", frame.camera());
  else if (camera.is_lost)
    events_.report(LogLevel::kInfo, {}, "camera {} is back, after {:.1f} s", frame.camera(),
                   to_seconds(now - camera.heard_at));
  camera.heard_at = now;
  camera.is_lost = false;
}

void VisionChanges::report_refusal(const Frame& frame, Camera& camera, Time now) {
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

void VisionChanges::update(const msg::WorldState& world, Time now) {
  for (auto& [number, camera] : cameras_) {
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
