// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/near_edge.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

constexpr int kGrey = 128;
constexpr double kShadedShare = 0.5;    // minimum fraction of the obstacle's chroma on its shaded side
constexpr double kMaxFloorShare = 0.3;  // maximum fraction of the obstacle's chroma on the floor
// Offset from the middle, in half widths, at which the floor is sampled.
constexpr double kFloorOffset = 1.5;
constexpr double kSampleHalfWidth = 0.2;  // in half widths: samples within this offset are averaged
constexpr int kSamplesPerSide = 2;
// Minimum distance of the foot as a fraction of near_m; no obstacle is high enough for less.
constexpr double kMinNearRatio = 0.6;
constexpr double kStepRatio = 0.004;  // fraction of near_m: about half a pixel

class HueSampler {
 public:
  HueSampler(const Silhouette& silhouette, const CameraModel& camera, const ImageView& image,
             const VerticalCylinders& robots)
      : silhouette_(silhouette), camera_(camera), image_(image), robots_(robots) {}

  /// The chroma at this distance and this offset from the middle (in half widths), as a fraction of the
  /// obstacle's chroma: the mean over the samples in the image that are not occluded. nullopt if there are
  /// none.
  std::optional<double> at(double distance_m, double offset) const {
    double sum = 0;
    int count = 0;
    for (int i = -kSamplesPerSide; i <= kSamplesPerSide; ++i) {
      const double bearing_rad =
          silhouette_.half_width_rad * (offset + kSampleHalfWidth * i / kSamplesPerSide);
      const Vec2 point_m =
          camera_.position_m().head<2>() + distance_m * rotated(silhouette_.direction, bearing_rad);
      const auto pixel = camera_.pixel_of({point_m.x(), point_m.y(), 0});
      if (!pixel || !camera_.is_in_image(*pixel) || is_occluded(point_m, robots_, camera_)) continue;
      const Yuv yuv = pixel_at(image_, static_cast<int>(std::floor(pixel->x() + 0.5)),
                               static_cast<int>(std::floor(pixel->y() + 0.5)));
      sum += Vec2(yuv.u - kGrey, yuv.v - kGrey).dot(silhouette_.chroma);
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / (count * silhouette_.chroma.squaredNorm());
  }

 private:
  const Silhouette& silhouette_;
  const CameraModel& camera_;
  const ImageView& image_;
  VerticalCylinders robots_;
};

}  // namespace

double near_edge_m(const Silhouette& silhouette, const CameraModel& camera, const ImageView& image,
                   const VerticalCylinders& robots) {
  if (silhouette.chroma.squaredNorm() == 0) return silhouette.near_m;
  const HueSampler hue(silhouette, camera, image, robots);
  const auto left = hue.at(silhouette.near_m, -kFloorOffset), right = hue.at(silhouette.near_m, kFloorOffset);
  if (!left && !right) return silhouette.near_m;
  const double floor = std::max(left ? *left : *right, right ? *right : *left);
  if (floor > kMaxFloorShare) return silhouette.near_m;
  const double threshold = 0.5 * (kShadedShare + floor), step_m = kStepRatio * silhouette.near_m;
  double near_m = silhouette.near_m;
  while (near_m > kMinNearRatio * silhouette.near_m) {
    const auto share = hue.at(near_m - step_m, 0);
    if (!share || *share < threshold) return near_m;
    near_m -= step_m;
  }
  return silhouette.near_m;
}

}  // namespace sidestep
