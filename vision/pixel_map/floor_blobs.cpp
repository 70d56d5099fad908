// SPDX-License-Identifier: Apache-2.0
#include "vision/pixel_map/floor_blobs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr int kMaxGap_px = 2;                     // between adjacent regions
constexpr int kIsolationMargin_px = 3;            // margin around a target that must show almost no colour
constexpr std::uint32_t kMaxOtherColour_px = 25;  // maximum number of other coloured pixels within the margin

bool are_adjacent(const ObstacleBlob& a, const ObstacleBlob& b) {
  return std::max(a.left_px, b.left_px) - std::min(a.right_px, b.right_px) <= kMaxGap_px &&
         std::max(a.top_px, b.top_px) - std::min(a.bottom_px, b.bottom_px) <= kMaxGap_px;
}

void unite(ObstacleBlob& a, const ObstacleBlob& b) {
  a.left_px = std::min(a.left_px, b.left_px);
  a.right_px = std::max(a.right_px, b.right_px);
  a.top_px = std::min(a.top_px, b.top_px);
  a.bottom_px = std::max(a.bottom_px, b.bottom_px);
  a.area_px += b.area_px;
}

}  // namespace

bool FloorBlobFinder::is_obstacle(const Yuv& pixel, const ColourClasses& classes) const {
  const auto colour = classes.colour_of(pixel);
  return colour && (settings_.ground_colours >> *colour & 1) == 0;
}

/// The region of the robot's colour and size; nullopt if there is not exactly one.
std::optional<Vec2> FloorBlobFinder::robot(std::span<const Region> regions) const {
  std::optional<Vec2> found;
  for (const Region& region : regions) {
    if (region.colour != static_cast<std::uint32_t>(settings_.robot) || !has_marker_size(region)) continue;
    if (found) return std::nullopt;
    found = Vec2(region.x_px, region.y_px);
  }
  return found;
}

/// Whether there is almost no other colour around a region. Patches of obstacles may have the target's
/// colour.
bool FloorBlobFinder::is_isolated(const ImageView& image, const ColourClasses& classes,
                                  const Region& region) const {
  std::uint32_t coloured_px = 0;
  const int left = std::max(0, region.left_px - kIsolationMargin_px),
            top = std::max(0, region.top_px - kIsolationMargin_px);
  const int right = std::min(image.width_px - 1, region.right_px + kIsolationMargin_px);
  const int bottom = std::min(image.height_px - 1, region.bottom_px + kIsolationMargin_px);
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) coloured_px += is_obstacle(pixel_at(image, x, y), classes) ? 1 : 0;
  return coloured_px <= region.area_px + kMaxOtherColour_px;
}

/// The isolated region of the target's colour and size; nullopt if there is not exactly one.
std::optional<Vec2> FloorBlobFinder::target(const ImageView& image, const ColourClasses& classes,
                                            std::span<const Region> regions) const {
  std::optional<Vec2> found;
  for (const Region& region : regions) {
    if (region.colour != static_cast<std::uint32_t>(settings_.target) || !has_marker_size(region) ||
        !is_isolated(image, classes, region))
      continue;
    if (found) return std::nullopt;
    found = Vec2(region.x_px, region.y_px);
  }
  return found;
}

/// Joins adjacent regions into obstacles, by their bounding boxes.
void FloorBlobFinder::collect(std::span<const Region> regions) {
  found_.obstacles.clear();
  for (const Region& region : regions) {
    if ((settings_.ground_colours >> region.colour & 1) != 0) continue;
    const Vec2 centre(region.x_px, region.y_px);
    if (found_.robot && (centre - *found_.robot).norm() < kMaxRobot_px) continue;
    ObstacleBlob merged;
    merged.left_px = region.left_px;
    merged.right_px = region.right_px;
    merged.top_px = region.top_px;
    merged.bottom_px = region.bottom_px;
    merged.area_px = region.area_px;
    for (std::size_t i = 0; i < found_.obstacles.size();) {
      if (!are_adjacent(merged, found_.obstacles[i])) {
        ++i;
        continue;
      }
      unite(merged, found_.obstacles[i]);
      found_.obstacles[i] = found_.obstacles.back();
      found_.obstacles.pop_back();
      i = 0;
    }
    found_.obstacles.push_back(merged);
  }
  std::erase_if(found_.obstacles, [&](const ObstacleBlob& blob) { return blob.area_px <= kMaxMarker_px; });
}

/// Fits diamond and disc to the coloured pixels in the bounding box, except those of the robot.
void FloorBlobFinder::measure(const ImageView& image, const ColourClasses& classes,
                              ObstacleBlob& blob) const {
  constexpr double kFar = std::numeric_limits<double>::max();
  double min_sum = kFar, max_sum = -kFar, min_difference = kFar, max_difference = -kFar, radius2 = 0;
  const Vec2 middle(0.5 * (blob.left_px + blob.right_px), 0.5 * (blob.top_px + blob.bottom_px));
  blob.centre = 0.5 * (middle + foot_of(middle));
  for (int y = blob.top_px; y <= blob.bottom_px; ++y) {
    for (int x = blob.left_px; x <= blob.right_px; ++x) {
      if (!is_obstacle(pixel_at(image, x, y), classes)) continue;
      const Vec2 pixel(x, y);
      if (found_.robot && (pixel - *found_.robot).norm() < kMaxRobot_px) continue;
      for (const Vec2& point : {pixel, foot_of(pixel)}) {
        min_sum = std::min(min_sum, point.x() + point.y());
        max_sum = std::max(max_sum, point.x() + point.y());
        min_difference = std::min(min_difference, point.x() - point.y());
        max_difference = std::max(max_difference, point.x() - point.y());
        radius2 = std::max(radius2, (point - blob.centre).squaredNorm());
      }
    }
  }
  // At a pixel's corners, the sum and the difference of the coordinates deviate by up to 1.
  min_sum -= 1, max_sum += 1, min_difference -= 1, max_difference += 1;
  const auto corner = [](double sum, double difference) {
    return Vec2(0.5 * (sum + difference), 0.5 * (sum - difference));
  };
  blob.diamond = {corner(min_sum, min_difference), corner(min_sum, max_difference),
                  corner(max_sum, max_difference), corner(max_sum, min_difference)};
  blob.radius_px = std::sqrt(radius2) + std::sqrt(0.5);
}

const FloorBlobs& FloorBlobFinder::find(const ImageView& image, const ColourClasses& classes,
                                        std::span<const Region> regions) {
  found_.robot = robot(regions);
  found_.target = target(image, classes, regions);
  collect(regions);
  for (ObstacleBlob& blob : found_.obstacles) measure(image, classes, blob);
  return found_;
}

}  // namespace sidestep
