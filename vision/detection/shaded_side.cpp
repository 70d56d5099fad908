// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/shaded_side.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/segmentation/colour_classes.hpp"

namespace sidestep {
namespace {

constexpr int kGrey = 128;
constexpr double kShade = 0.5;       // of its colour that a side shows
constexpr double kMostGround = 0.3;  // of its colour that the ground may show
constexpr double kBeside = 1.5;      // times its half width aside there is ground
constexpr double kAcross = 0.2;      // of its half width, to either side, is looked at
constexpr int kPoints = 2;           // to either side
constexpr double kFarthest = 0.6;    // of near_m: nothing is that high
constexpr double kStep = 0.004;      // of near_m, about half a pixel

class Hue {
 public:
  Hue(const SeenThing& thing, const CameraModel& camera, const ImageView& image, const Uprights& robots)
      : thing_(thing), camera_(camera), image_(image), robots_(robots) {}

  /// How much of the thing's colour the floor shows at a distance and a share of the half width aside, in the
  /// mean of those points across that are in view and not hidden; 1 is all. Nothing where none is.
  std::optional<double> at(double distance_m, double aside) const {
    double sum = 0;
    int count = 0;
    for (int i = -kPoints; i <= kPoints; ++i) {
      const double bearing_rad = thing_.half_rad * (aside + kAcross * i / kPoints);
      const Vec2 place = camera_.position_m().head<2>() + distance_m * rotated(thing_.ahead, bearing_rad);
      const auto pixel = camera_.pixel_of({place.x(), place.y(), 0});
      if (!pixel || !camera_.shows(*pixel) || hide(robots_, place, camera_)) continue;
      const Yuv seen = pixel_at(image_, static_cast<int>(std::floor(pixel->x() + 0.5)),
                                static_cast<int>(std::floor(pixel->y() + 0.5)));
      sum += Vec2(seen.u - kGrey, seen.v - kGrey).dot(thing_.colour);
      ++count;
    }
    if (count == 0) return std::nullopt;
    return sum / (count * thing_.colour.squaredNorm());
  }

 private:
  const SeenThing& thing_;
  const CameraModel& camera_;
  const ImageView& image_;
  Uprights robots_;
};

}  // namespace

double near_with_shade_m(const SeenThing& thing, const CameraModel& camera, const ImageView& image,
                         const Uprights& robots) {
  if (thing.colour.squaredNorm() == 0) return thing.near_m;
  const Hue hue(thing, camera, image, robots);
  const auto left = hue.at(thing.near_m, -kBeside), right = hue.at(thing.near_m, kBeside);
  if (!left && !right) return thing.near_m;
  const double ground = std::max(left ? *left : *right, right ? *right : *left);
  if (ground > kMostGround) return thing.near_m;
  const double least = 0.5 * (kShade + ground), step_m = kStep * thing.near_m;
  double near_m = thing.near_m;
  while (near_m > kFarthest * thing.near_m) {
    const auto seen = hue.at(near_m - step_m, 0);
    if (!seen || *seen < least) return near_m;
    near_m -= step_m;
  }
  return thing.near_m;
}

}  // namespace sidestep
