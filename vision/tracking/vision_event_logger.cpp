// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/vision_event_logger.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {

VisionEventLogger::VisionEventLogger(const EventReporter& events, const std::vector<std::uint32_t>& cameras,
                                     double max_disagreement_m)
    : events_(events), max_disagreement_m_(max_disagreement_m) {
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

void VisionEventLogger::update(std::span<const CameraDisagreement> pairs, Time now) {
  for (const CameraDisagreement& pair : pairs) {
    if (pair.samples < kReportedSamples) continue;
    const double offset_m = pair.offset_m.norm();
    // Differences that are not corrected are noise.
    const double difference_m = pair.is_corrected ? offset_m : 0;
    const auto reported = reported_m_.find({pair.first, pair.second});
    const bool is_reportable = reported == reported_m_.end() ||
                               std::abs(difference_m - reported->second) > 0.1 * difference_m + 0.001;
    if (!is_reportable || !pair_reports_.admit(now)) continue;
    reported_m_[{pair.first, pair.second}] = difference_m;
    if (!pair.is_corrected) {
      events_.report(LogLevel::kDebug, {}, "cameras {} and {} agree within {:.1f} mm", pair.first,
                     pair.second, std::max(offset_m, CameraOffsets::kMinOffset_m) * 1e3);
      continue;
    }
    events_.report(
        offset_m > max_disagreement_m_ ? LogLevel::kWarning : LogLevel::kInfo, {},
        "cameras {} and {} disagree by {:.1f} mm (x {:+.1f}, y {:+.1f}, each with {:.1f} mm of noise): "
        "each is corrected by half of it, but either may be wrong by all of it until it is calibrated",
        pair.first, pair.second, offset_m * 1e3, pair.offset_m.x() * 1e3, pair.offset_m.y() * 1e3,
        pair.scatter_m / std::sqrt(2.0) * 1e3);
  }
}

}  // namespace sidestep
