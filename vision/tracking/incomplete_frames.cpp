// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/incomplete_frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/protocol/obstacle_bounds.hpp"

namespace sidestep {
namespace {

/// The largest distance of any of the points from the nearest of the others; infinite if there are no others.
double max_distance_m(std::span<const Vec2> points_m, std::span<const Vec2> others_m) {
  double max_squared = 0;
  for (const Vec2& point : points_m) {
    double min_squared = std::numeric_limits<double>::infinity();
    for (const Vec2& other : others_m) min_squared = std::min(min_squared, (other - point).squaredNorm());
    max_squared = std::max(max_squared, min_squared);
  }
  return std::sqrt(max_squared);
}

}  // namespace

void IncompleteFrames::update(const Frame& frame, double complete_within_m) {
  std::erase_if(frames_,
                [&](const IncompleteFrame& old) { return frame.captured_at() - old.captured_at > max_age_; });
  const auto found = std::ranges::find(frames_, frame.camera(), &IncompleteFrame::camera);
  const bool is_known = found != frames_.end();
  if (is_known && found->captured_at > frame.captured_at()) return;
  if (complete_within_m >= kCompleteEverywhere_m) {
    if (is_known) frames_.erase(found);
    return;
  }
  IncompleteFrame& latest = is_known ? *found : frames_.emplace_back();
  latest.camera = frame.camera();
  latest.captured_at = frame.captured_at();
  latest.date_uncertainty = frame.date_uncertainty();
  latest.complete_within_m = complete_within_m;
  latest.robots_m.clear();
  for (const RobotPoseObservation& robot : frame.robots()) latest.robots_m.push_back(robot.position_m);
}

double IncompleteFrames::complete_within_m(std::span<const Vec2> robots_m, Time t) const {
  double distance = kCompleteEverywhere_m;
  for (const IncompleteFrame& frame : frames_) {
    if (t - frame.captured_at > max_age_) continue;
    // The distance is known only for the frame's robots. Other robots may be nearer to a missing obstacle by
    // up to their distance from the nearest of these.
    const Duration age = std::chrono::abs(t - frame.captured_at) + frame.date_uncertainty;
    const double uncertainty =
        max_distance_m(robots_m, frame.robots_m) + max_error_m_ + max_speed_mps_ * to_seconds(age);
    distance = robots_m.empty() ? 0 : std::min(distance, frame.complete_within_m - uncertainty);
  }
  return std::max(0.0, distance);
}

}  // namespace sidestep
