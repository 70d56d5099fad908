// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_handovers.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

namespace sidestep {
namespace {

/// A camera that has not seen the robot for longer begins anew.
constexpr Duration kMaxAbsence{500'000'000};
/// A camera whose latest sighting is older has lost the robot.
constexpr Duration kRecent{60'000'000};
/// After so many frames without a comparison, the camera is used as it is.
constexpr int kMaxFrames = 5;

Vec2 faded(const Vec2& shift_m, double by_m) {
  const double length_m = shift_m.norm();
  return length_m <= by_m ? Vec2(0, 0) : Vec2(shift_m * (1 - by_m / length_m));
}

/// The noise of two observations exceeds this many of their standard deviations less than once in 100,000
/// times.
constexpr double kNoiseDeviations = 5;

}  // namespace

CameraHandovers::CameraHandovers(double noise_m)
    : min_shift_m_(std::max(CameraOffsets::kMinOffset_m, kNoiseDeviations * std::numbers::sqrt2 * noise_m)),
      robots_(kMaxRobots) {}

void CameraHandovers::shift(Frame& frame) {
  frame.keep_robots([&](RobotPoseObservation& robot) {
    Sights& sights = robots_[robot.robot];
    Sight& sight = sight_of(sights, frame.camera(), frame.captured_at());
    update(sights, sight, {frame.captured_at(), robot.position_m});
    robot.position_m += sight.shift_m;
    return sight.is_known;
  });
}

/// The camera's entry, or the one that was used least recently.
CameraHandovers::Sight& CameraHandovers::sight_of(Sights& sights, std::uint32_t camera, Time captured_at) {
  auto found = std::ranges::find_if(
      sights, [camera](const Sight& sight) { return sight.frames > 0 && sight.camera == camera; });
  if (found == sights.end()) {
    found = std::ranges::min_element(sights, {}, [](const Sight& sight) {
      return sight.frames == 0 ? Time::min() : sight.latest.captured_at;
    });
    *found = Sight();
  } else if (captured_at - found->latest.captured_at > kMaxAbsence) {
    *found = Sight();
  }
  found->camera = camera;
  return *found;
}

void CameraHandovers::update(const Sights& sights, Sight& sight, const CameraSighting& now) const {
  const bool is_first = sight.frames == 0;
  if (!is_first && now.captured_at <= sight.latest.captured_at) return;
  const CameraSighting before = std::exchange(sight.latest, now);
  sight.frames = std::min(sight.frames + 1, kMaxFrames);
  if (sight.is_known) return;
  bool is_alone = true;
  for (const Sight& other : sights) {
    if (!other.is_known || other.camera == sight.camera) continue;
    if (std::chrono::abs(now.captured_at - other.latest.captured_at) > kRecent) continue;
    is_alone = false;
    if (is_first) continue;
    const auto here_m = position_between(before, now, other.latest.captured_at);
    if (!here_m) continue;
    const Vec2 shift_m = other.latest.position_m + other.shift_m - *here_m;
    const auto last_m = std::exchange(sight.compared_m, shift_m);
    // A false detection of one of the cameras contradicts the other comparisons.
    if (!last_m || !((shift_m - *last_m).norm() <= min_shift_m_)) break;
    sight.is_known = true;
    // Further apart they do not see the same robot. The comparisons are false for NaN.
    if (shift_m.norm() > min_shift_m_ && shift_m.norm() <= CameraOffsets::kMaxOffset_m)
      sight.shift_m = shift_m;
    return;
  }
  sight.is_known = is_alone || sight.frames == kMaxFrames;
}

void CameraHandovers::advance(Duration elapsed) {
  const double by_m = CameraOffsets::kMaxChange_mps * std::max(to_seconds(elapsed), 0.0);
  for (Sights& sights : robots_) {
    for (Sight& sight : sights) sight.shift_m = faded(sight.shift_m, by_m);
  }
}

void CameraHandovers::forget() { robots_.assign(robots_.size(), Sights()); }

}  // namespace sidestep
