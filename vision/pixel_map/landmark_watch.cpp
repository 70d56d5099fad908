// SPDX-License-Identifier: Apache-2.0
#include "vision/pixel_map/landmark_watch.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/geometry/field_marking.hpp"
#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

constexpr double kSpacing_m = 0.08;  ///< distance between landmarks along a line
/// Maximum distance from its predicted place at which a line is searched.
constexpr int kReach_px = 8;
constexpr int kMinContrast = 30;       ///< minimum contrast of a line against the surface beside it, of 255
constexpr double kMaxOffset_px = 1.5;  ///< maximum offset of a landmark that counts as in place
/// Minimum fraction of landmarks that are visible, and of visible landmarks that are in place.
constexpr double kMinShare = 0.7;
constexpr int kGoodFrames = 5;  ///< number of good frames after which a lost camera counts as known again

/// The offset along the normal at which a line is brightest; nullopt if it is not visible.
std::optional<double> line_offset_px(const ImageView& image, const Vec2& pixel, const Vec2& normal) {
  int darkest = 255, brightest = 0, best = 0;
  const auto brightness = [&](int offset) {
    const Vec2 at = pixel + offset * normal;
    return static_cast<int>(
        pixel_at(image, static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))).y);
  };
  for (int offset = -kReach_px; offset <= kReach_px; ++offset) {
    const int value = brightness(offset);
    darkest = std::min(darkest, value);
    if (value <= brightest) continue;
    brightest = value;
    best = offset;
  }
  if (brightest - darkest < kMinContrast) return std::nullopt;
  double weight = 0, moment = 0;
  for (int offset = std::max(best - 2, -kReach_px); offset <= std::min(best + 2, kReach_px); ++offset) {
    const double above = std::max(0, brightness(offset) - darkest - (brightest - darkest) / 4);
    weight += above;
    moment += above * offset;
  }
  return moment / weight;
}

}  // namespace

LandmarkWatch::LandmarkWatch(const CameraModel& camera, const Field& field) {
  for (const MarkedLine& line : FieldMarking(field).lines)
    add_line(camera, line.segment_m.from_m, line.segment_m.to_m);
  for (const std::vector<Landmark>& landmarks : landmarks_)
    if (landmarks.size() < kMinLandmarks)
      throw std::invalid_argument("landmark watch: the camera sees too little of the field's lines");
}

void LandmarkWatch::add_line(const CameraModel& camera, const Vec2& from_m, const Vec2& to_m) {
  const double length_m = (to_m - from_m).norm();
  const Vec2 along_m = (to_m - from_m) / length_m;
  // Skips the ends of the line, where other lines cross it, and half a spacing.
  for (double at_m = kSpacing_m; at_m < length_m - kSpacing_m / 2; at_m += kSpacing_m) {
    const Vec2 point_m = from_m + at_m * along_m, next_m = point_m + 0.01 * along_m;
    const auto pixel = camera.pixel_of({point_m.x(), point_m.y(), 0});
    const auto next = camera.pixel_of({next_m.x(), next_m.y(), 0});
    if (!pixel || !next) continue;
    const Vec2 along = (*next - *pixel).normalized(), normal(-along.y(), along.x());
    const Vec2 reach = (kReach_px + 1) * normal;
    if (!camera.is_in_image(*pixel - reach) || !camera.is_in_image(*pixel + reach)) continue;
    landmarks_[std::abs(normal.x()) > std::abs(normal.y()) ? 0 : 1].push_back({*pixel, normal});
  }
}

bool LandmarkWatch::is_in_place(const ImageView& image, const std::vector<Landmark>& landmarks) const {
  std::size_t visible = 0, in_place = 0;
  for (const Landmark& landmark : landmarks) {
    const auto offset_px = line_offset_px(image, landmark.pixel, landmark.normal);
    if (!offset_px) continue;
    ++visible;
    in_place += std::abs(*offset_px) <= kMaxOffset_px ? 1 : 0;
  }
  const auto is_enough = [&](std::size_t part, std::size_t of) {
    return static_cast<double>(part) >= kMinShare * static_cast<double>(of);
  };
  return is_enough(visible, landmarks.size()) && is_enough(in_place, visible);
}

bool LandmarkWatch::update(const ImageView& image) {
  const bool is_good = std::ranges::all_of(
      landmarks_, [&](const std::vector<Landmark>& landmarks) { return is_in_place(image, landmarks); });
  good_frames_ = is_good ? good_frames_ + 1 : 0;
  if (!is_good) is_known_ = false;
  if (good_frames_ >= kGoodFrames) is_known_ = true;
  return is_known_;
}

}  // namespace sidestep
