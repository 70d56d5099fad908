// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/obstacle_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/vec2.hpp"
#include "vision/detection/near_edge.hpp"
#include "vision/patterns/projected_region.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMaxBlobs = 1024;  // more blobs would take too long to merge
constexpr int kMaxGap_px = 2;            // between adjacent regions
// Minimum area of a region relative to the smallest obstacle; smaller regions are noise.
constexpr double kMinRegionAreaRatio = 0.15;
// Maximum area of a dot or ball relative to the largest dot.
constexpr double kMaxDotAreaRatio = 3;
constexpr double kMinFillRatio = 0.6;      // minimum coloured fraction of the pixels inside the contour
constexpr double kMaxHalfWidthSine = 0.7;  // beyond this, the obstacle is treated as being below the camera

// Known obstacles are extended by this margin; circles are assumed to be this high.
constexpr double kKnownMargin_m = 0.04, kKnownHeight_m = 0.3;

constexpr int kGrey = 128;

double disc_m2(double radius_m) { return std::numbers::pi * radius_m * radius_m; }

bool has(std::uint32_t colours, std::uint32_t colour) { return (colours >> colour & 1) != 0; }

}  // namespace

bool ObstacleFinder::is_on_robot(const Vec2& pixel, const VerticalCylinders& robots) const {
  const auto floor_m = camera_.point_at(pixel, 0);
  return floor_m && is_occluded(*floor_m, robots, camera_);
}

bool ObstacleFinder::is_region_on_robot(const Region& region, const VerticalCylinders& robots) const {
  return is_on_robot({region.x_px, region.y_px}, robots) &&
         is_on_robot({region.left_px, region.y_px}, robots) &&
         is_on_robot({region.right_px, region.y_px}, robots) &&
         is_on_robot({region.x_px, region.top_px}, robots) &&
         is_on_robot({region.x_px, region.bottom_px}, robots);
}

void ObstacleFinder::collect_blobs(std::span<const Region> regions, const VerticalCylinders& robots) {
  const auto are_adjacent = [](const Blob& a, const Blob& b) {
    return std::max(a.left_px, b.left_px) - std::min(a.right_px, b.right_px) <= kMaxGap_px &&
           std::max(a.top_px, b.top_px) - std::min(a.bottom_px, b.bottom_px) <= kMaxGap_px;
  };
  blobs_.clear();
  has_overflowed_ = false;
  for (const Region& region : regions) {
    if (has(settings_.ground_colours, region.colour)) continue;
    const auto projected = project_region(region, camera_, 0);
    if (!projected || projected->area_m2 < kMinRegionAreaRatio * disc_m2(settings_.min_radius_m)) continue;
    if (is_region_on_robot(region, robots)) continue;
    if (blobs_.size() == kMaxBlobs) {
      has_overflowed_ = true;
      break;
    }
    Blob merged{region, region.left_px, region.right_px, region.top_px, region.bottom_px, region.area_px};
    for (std::size_t i = 0; i < blobs_.size();) {
      if (!are_adjacent(merged, blobs_[i])) {
        ++i;
        continue;
      }
      const Blob& other = blobs_[i];
      if (other.largest.area_px > merged.largest.area_px) merged.largest = other.largest;
      merged.left_px = std::min(merged.left_px, other.left_px);
      merged.right_px = std::max(merged.right_px, other.right_px);
      merged.top_px = std::min(merged.top_px, other.top_px);
      merged.bottom_px = std::max(merged.bottom_px, other.bottom_px);
      merged.area_px += other.area_px;
      blobs_[i] = blobs_.back();
      blobs_.pop_back();
      i = 0;  // the merged blob may touch blobs that were skipped
    }
    blobs_.push_back(merged);
  }
}

bool ObstacleFinder::is_larger_than_dot(const Blob& blob) const {
  const Vec2 middle(0.5 * (blob.left_px + blob.right_px), 0.5 * (blob.top_px + blob.bottom_px));
  const auto middle_m = camera_.point_at(middle, 0);
  const auto scale = middle_m ? px2_per_m2(camera_, {middle_m->x(), middle_m->y(), 0}) : std::nullopt;
  if (!scale) return false;
  return blob.area_px / *scale > kMaxDotAreaRatio * disc_m2(settings_.max_dot_radius_m);
}

bool ObstacleFinder::find_contour(const Blob& blob, const ImageView& image, const ColourClasses& classes,
                                  const VerticalCylinders& robots) {
  contour_.clear();
  chroma_ = Vec2(0, 0);
  int rows = 0;
  std::int64_t enclosed_px = 0;
  const auto is_coloured = [&](int x, int y) {
    const auto colour = classes.colour_of(pixel_at(image, x, y));
    return colour && !has(settings_.ground_colours, *colour) && !is_on_robot(Vec2(x, y), robots);
  };
  const auto add = [&](double x, double y) {
    if (const auto floor_m = camera_.point_at({x, y}, 0)) contour_.push_back(*floor_m);
  };
  for (int y = blob.top_px; y <= blob.bottom_px; ++y) {
    int left = blob.left_px, right = blob.right_px;
    while (left <= right && !is_coloured(left, y)) ++left;
    while (right > left && !is_coloured(right, y)) --right;
    if (left > right) continue;
    enclosed_px += right - left + 1;
    const Yuv middle = pixel_at(image, (left + right) / 2, y);
    chroma_ += (Vec2(middle.u - kGrey, middle.v - kGrey) - chroma_) / ++rows;
    for (const double edge : {-0.5, 0.5}) {
      add(left - 0.5, y + edge);
      add(right + 0.5, y + edge);
    }
  }
  return !contour_.empty() && blob.area_px >= kMinFillRatio * static_cast<double>(enclosed_px);
}

/// Whether a point on the floor is hidden by a wall, a map cell or another shape that is not a circle.
bool ObstacleFinder::is_in_shadow_of_floor(const Vec2& floor_m) const {
  const Vec3& eye_m = camera_.position_m();
  const double share = std::min(1.0, kRobotHeight_m / eye_m.z());
  const Segment ray{floor_m, floor_m + share * (eye_m.head<2>() - floor_m)};
  constexpr double kMargin2_m2 = kKnownMargin_m * kKnownMargin_m;
  return std::ranges::any_of(settings_.known_obstacles,
                             [&](const Shape& known) {
                               return !std::holds_alternative<Circle>(known) &&
                                      squared_distance(ray, known) <= kMargin2_m2;
                             }) ||
         (settings_.known_map && touches(settings_.known_map->cells(), settings_.known_map->field(),
                                         ray.from_m, ray.to_m, kKnownMargin_m));
}

/// Whether the whole contour lies in the shadow of one known circle, or of the other shapes together, which
/// may be parts of one wall.
bool ObstacleFinder::is_in_known_shadow() const {
  return std::ranges::any_of(settings_.known_obstacles,
                             [&](const Shape& known) {
                               const auto* const circle = std::get_if<Circle>(&known);
                               if (!circle) return false;
                               const Circle extended{circle->centre_m, circle->radius_m + kKnownMargin_m};
                               const VerticalCylinders cylinder{{&extended, 1}, kKnownHeight_m};
                               return std::ranges::all_of(contour_, [&](const Vec2& point) {
                                 return is_occluded(point, cylinder, camera_);
                               });
                             }) ||
         std::ranges::all_of(contour_, [&](const Vec2& point) { return is_in_shadow_of_floor(point); });
}

/// Whether a circle lies within a known obstacle, which does not depend on the obstacle's height.
bool ObstacleFinder::is_within_known(const Circle& circle) const {
  return std::ranges::any_of(settings_.known_obstacles, [&](const Shape& known) {
    return signed_distance(circle.centre_m, known) + circle.radius_m <= kKnownMargin_m;
  });
}

/// Fits the circle that subtends the contour's angle as seen from the point below the camera, at the
/// contour's distance, because in the image vertical sides extend radially away from that point. An obstacle
/// almost below the camera gets its apparent size.
Circle ObstacleFinder::fit_circle(const ImageView& image, const VerticalCylinders& robots) const {
  const Vec2 below_m = camera_.position_m().head<2>();
  Vec2 low = contour_[0], high = contour_[0];
  for (const Vec2& point : contour_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vec2 middle = 0.5 * (low + high), direction = (middle - below_m).normalized();
  double near_m = (middle - below_m).norm(), apparent_radius_m = 0, min_rad = 0, max_rad = 0;
  for (const Vec2& point : contour_) {
    const Vec2 offset = point - below_m;
    const double bearing_rad = std::atan2(cross(direction, offset), direction.dot(offset));
    min_rad = std::min(min_rad, bearing_rad);
    max_rad = std::max(max_rad, bearing_rad);
    near_m = std::min(near_m, offset.norm());
    apparent_radius_m = std::max(apparent_radius_m, (point - middle).norm());
  }
  const double half_width_sine = std::sin(std::min(0.5 * (max_rad - min_rad), 0.5 * std::numbers::pi));
  if ((middle - below_m).norm() <= apparent_radius_m || half_width_sine > kMaxHalfWidthSine)
    return {middle, apparent_radius_m};
  const Silhouette silhouette{rotated(direction, 0.5 * (min_rad + max_rad)), near_m,
                              0.5 * (max_rad - min_rad), chroma_};
  near_m = near_edge_m(silhouette, camera_, image, robots);
  const double radius_m = near_m * half_width_sine / (1 - half_width_sine);
  return {below_m + (near_m + radius_m) * silhouette.direction, radius_m};
}

std::span<Circle> ObstacleFinder::find(const ImageView& image, const ColourClasses& classes,
                                       std::span<const Region> regions, std::span<const Circle> robots) {
  const VerticalCylinders robot_cylinders{robots, kRobotHeight_m};
  found_.clear();
  obstacles_.clear();
  collect_blobs(regions, robot_cylinders);
  std::ranges::sort(blobs_, std::greater{}, &Blob::area_px);
  for (const Blob& blob : blobs_) {
    if (!is_larger_than_dot(blob) || !find_contour(blob, image, classes, robot_cylinders)) continue;
    if (is_in_known_shadow()) {
      found_.push_back(blob);
      continue;
    }
    const Circle circle = fit_circle(image, robot_cylinders);
    if (circle.radius_m < settings_.min_radius_m) continue;
    found_.push_back(blob);
    if (!is_within_known(circle)) obstacles_.push_back(circle);
  }
  return obstacles_;
}

bool ObstacleFinder::is_part_of_obstacle(const Region& region) const {
  return std::ranges::any_of(found_, [&](const Blob& blob) {
    const Region& whole = blob.largest;
    return region.left_px >= whole.left_px && region.right_px <= whole.right_px &&
           region.top_px >= whole.top_px && region.bottom_px <= whole.bottom_px;
  });
}

}  // namespace sidestep
