// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_offsets.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

/// Frames of one camera that are further apart are not interpolated.
constexpr Duration kMaxInterpolation{60'000'000};
/// A sample further from the mean than this many standard deviations, plus kMinGate_m, is not of the same
/// robot or place, unless there are kMaxContradictions in sequence: then a camera was moved.
constexpr double kOffsetGateDeviations = 5, kMinGate_m = 0.01;
constexpr int kMaxContradictions = 60;
constexpr double kSignificance = 4;  // standard deviations of the mean
constexpr std::size_t kMaxPairs = 256;

Vec2 limited_step(const Vec2& step, double max_m) {
  const double length_m = step.norm();
  return length_m <= max_m ? step : Vec2(step * (max_m / length_m));
}

bool is_significant(const CameraDisagreement& pair) {
  const double error_m = pair.scatter_m / std::sqrt(std::max(pair.samples, 1));
  return pair.samples >= CameraOffsets::kMinSamples && pair.offset_m.norm() <= CameraOffsets::kMaxOffset_m &&
         pair.offset_m.norm() > CameraOffsets::kMinOffset_m + kSignificance * error_m;
}

}  // namespace

std::optional<Vec2> position_between(const CameraSighting& before, const CameraSighting& after, Time at) {
  const Duration period = after.captured_at - before.captured_at;
  if (period <= Duration{0} || period > kMaxInterpolation) return std::nullopt;
  if (at < before.captured_at || at > after.captured_at) return std::nullopt;
  const double part = to_seconds(at - before.captured_at) / to_seconds(period);
  return before.position_m + part * (after.position_m - before.position_m);
}

CameraOffsets::CameraOffsets(const std::vector<std::uint32_t>& cameras) : robots_(kMaxRobots) {
  for (const std::uint32_t camera : cameras) corrections_m_.emplace(camera, Vec2(0, 0));
  pairs_.reserve(kMaxPairs);
}

void CameraOffsets::add(const Frame& frame) {
  for (const RobotPoseObservation& robot : frame.robots()) {
    Sightings& sightings = robots_[robot.robot];
    const Sighting sighting{{frame.captured_at(), robot.position_m}, frame.camera()};
    compare(sightings, sighting);
    sightings.latest[sightings.next] = sighting;
    sightings.next = (sightings.next + 1) % sightings.latest.size();
    sightings.count = std::min(sightings.count + 1, sightings.latest.size());
  }
}

void CameraOffsets::compare(const Sightings& robot, const Sighting& now) {
  const Sighting* before = nullptr;
  for (std::size_t age = 0; age < robot.count && !before; ++age)
    if (robot.back(age).camera == now.camera) before = &robot.back(age);
  if (!before) return;
  for (std::size_t age = 0; age < robot.count; ++age) {
    const Sighting& other = robot.back(age);
    if (other.camera == now.camera || other.captured_at <= before->captured_at) continue;
    if (const auto here_m = position_between(*before, now, other.captured_at))
      add_sample(now.camera, other.camera, other.position_m - *here_m);
  }
}

void CameraOffsets::add_sample(std::uint32_t camera, std::uint32_t other, const Vec2& offset_m) {
  // The comparison is false for NaN.
  if (!(offset_m.norm() <= kMaxOffset_m)) return;
  const auto [first, second] = std::minmax(camera, other);
  const Vec2 sample_m = camera == first ? offset_m : Vec2(-offset_m);
  auto pair = std::ranges::find_if(pairs_, [first = first, second = second](const CameraDisagreement& p) {
    return p.first == first && p.second == second;
  });
  if (pair == pairs_.end()) {
    if (pairs_.size() == kMaxPairs) return;
    pair = pairs_.insert(pairs_.end(), CameraDisagreement{first, second});
  }
  CameraDisagreement& measured = *pair;
  const Vec2 deviation_m = sample_m - measured.offset_m;
  const bool is_far = measured.samples >= kMinSamples &&
                      deviation_m.norm() > kMinGate_m + kOffsetGateDeviations * measured.scatter_m;
  if (is_far && ++measured.contradictions < kMaxContradictions) return;
  if (is_far) measured.samples = 0;
  measured.contradictions = 0;
  measured.samples = std::min(measured.samples + 1, kMaxSamples);
  const double weight = 1.0 / measured.samples;
  if (measured.samples == 1) {
    measured.offset_m = sample_m;
    measured.scatter_m = 0;
    return;
  }
  measured.offset_m += weight * deviation_m;
  // Half of the squared length is the variance on each axis.
  const double variance_m2 =
      (1 - weight) * (measured.scatter_m * measured.scatter_m + weight * deviation_m.squaredNorm() / 2);
  measured.scatter_m = std::sqrt(variance_m2);
}

void CameraOffsets::advance(Duration elapsed) {
  for (CameraDisagreement& measured : pairs_)
    if (is_significant(measured)) measured.is_corrected = true;
  const auto count_pairs = [&](std::uint32_t camera) {
    return std::ranges::count_if(pairs_, [&](const CameraDisagreement& pair) {
      return pair.is_corrected && (pair.first == camera || pair.second == camera);
    });
  };
  const double max_m = kMaxChange_mps * std::max(to_seconds(elapsed), 0.0);
  for (const CameraDisagreement& measured : pairs_) {
    if (!measured.is_corrected || measured.samples < kMinSamples) continue;
    Vec2 &first_m = corrections_m_.at(measured.first), &second_m = corrections_m_.at(measured.second);
    // Each pair of a camera adds a step.
    const auto pairs =
        static_cast<double>(std::max(count_pairs(measured.first), count_pairs(measured.second)));
    const Vec2 step = limited_step((measured.offset_m + second_m - first_m) / 2, max_m / pairs);
    first_m += step;
    second_m -= step;
  }
}

Vec2 CameraOffsets::correction_m(std::uint32_t camera) const {
  const auto found = corrections_m_.find(camera);
  return found == corrections_m_.end() ? Vec2(0, 0) : found->second;
}

double CameraOffsets::noise_m() const {
  double noise_m = 0;
  for (const CameraDisagreement& pair : pairs_) {
    if (!pair.is_corrected) continue;
    const Vec2 rest_m = pair.offset_m + correction_m(pair.second) - correction_m(pair.first);
    noise_m = std::max(noise_m, std::hypot(pair.scatter_m / std::sqrt(2.0), rest_m.norm() / 2));
  }
  return noise_m;
}

void CameraOffsets::forget() {
  for (Sightings& robot : robots_) robot.count = 0;
}

}  // namespace sidestep
