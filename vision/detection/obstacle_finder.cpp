// SPDX-License-Identifier: Apache-2.0
#include "vision/detection/obstacle_finder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/vec2.hpp"
#include "vision/detection/shaded_side.hpp"
#include "vision/patterns/patch.hpp"

namespace sidestep {
namespace {

constexpr std::size_t kMostBlobs = 256;  // a frame with more is noise
constexpr int kGap_px = 2;               // between regions that touch
constexpr double kLeastPiece = 0.15;     // of the least obstacle's area: smaller regions are edges and noise
constexpr double kMostDot = 3;           // times the largest dot's area: what is larger is none, nor a ball
constexpr double kSolid = 0.6;           // of what lies between its sides has its colour
constexpr double kNearlyBelow = 0.7;     // sine of half the angle that it is wide, seen from below the camera

// A known obstacle may seem to reach so far beyond where it is known to be, and is taken for so high.
constexpr double kBeyond_m = 0.04, kHigh_m = 0.3;

constexpr int kGrey = 128;

double disc_m2(double radius_m) { return std::numbers::pi * radius_m * radius_m; }

bool has(std::uint32_t colours, std::uint32_t colour) { return (colours >> colour & 1) != 0; }

}  // namespace

bool ObstacleFinder::is_on_robot(const Vec2& pixel, const Uprights& robots) const {
  const auto floor_m = camera_.point_at(pixel, 0);
  return floor_m && hide(robots, *floor_m, camera_);
}

bool ObstacleFinder::is_of_robot(const Region& region, const Uprights& robots) const {
  return is_on_robot({region.x_px, region.y_px}, robots) &&
         is_on_robot({region.left_px, region.y_px}, robots) &&
         is_on_robot({region.right_px, region.y_px}, robots) &&
         is_on_robot({region.x_px, region.top_px}, robots) &&
         is_on_robot({region.x_px, region.bottom_px}, robots);
}

void ObstacleFinder::gather(std::span<const Region> regions, const Uprights& robots) {
  const auto touch = [](const Blob& a, const Blob& b) {
    return std::max(a.left_px, b.left_px) - std::min(a.right_px, b.right_px) <= kGap_px &&
           std::max(a.top_px, b.top_px) - std::min(a.bottom_px, b.bottom_px) <= kGap_px;
  };
  blobs_.clear();
  for (const Region& region : regions) {
    if (has(rules_.ground, region.colour) || blobs_.size() == kMostBlobs) continue;
    const auto patch = patch_of(region, camera_, 0);
    if (!patch || patch->area_m2 < kLeastPiece * disc_m2(rules_.least_radius_m)) continue;
    if (is_of_robot(region, robots)) continue;
    Blob grown{region, region.left_px, region.right_px, region.top_px, region.bottom_px, region.area_px};
    for (std::size_t i = 0; i < blobs_.size();) {
      if (!touch(grown, blobs_[i])) {
        ++i;
        continue;
      }
      const Blob& other = blobs_[i];
      if (other.largest.area_px > grown.largest.area_px) grown.largest = other.largest;
      grown.left_px = std::min(grown.left_px, other.left_px);
      grown.right_px = std::max(grown.right_px, other.right_px);
      grown.top_px = std::min(grown.top_px, other.top_px);
      grown.bottom_px = std::max(grown.bottom_px, other.bottom_px);
      grown.area_px += other.area_px;
      blobs_[i] = blobs_.back();
      blobs_.pop_back();
      i = 0;  // it may reach now what it did not
    }
    blobs_.push_back(grown);
  }
}

bool ObstacleFinder::is_large(const Blob& blob) const {
  const Vec2 middle(0.5 * (blob.left_px + blob.right_px), 0.5 * (blob.top_px + blob.bottom_px));
  const auto at_m = camera_.point_at(middle, 0);
  const auto covered = at_m ? px2_per_m2(camera_, {at_m->x(), at_m->y(), 0}) : std::nullopt;
  if (!covered) return false;
  return blob.area_px / *covered > kMostDot * disc_m2(rules_.largest_dot_m);
}

bool ObstacleFinder::find_outline(const Blob& blob, const ImageView& image, const ColourClasses& classes,
                                  const Uprights& robots) {
  outline_.clear();
  colour_ = Vec2(0, 0);
  int rows = 0;
  std::int64_t within_px = 0;
  const auto is_its = [&](int x, int y) {
    const auto colour = classes.colour_of(pixel_at(image, x, y));
    return colour && !has(rules_.ground, *colour) && !is_on_robot(Vec2(x, y), robots);
  };
  const auto add = [&](double x, double y) {
    if (const auto at_m = camera_.point_at({x, y}, 0)) outline_.push_back(*at_m);
  };
  for (int y = blob.top_px; y <= blob.bottom_px; ++y) {
    int left = blob.left_px, right = blob.right_px;
    while (left <= right && !is_its(left, y)) ++left;
    while (right > left && !is_its(right, y)) --right;
    if (left > right) continue;
    within_px += right - left + 1;
    const Yuv middle = pixel_at(image, (left + right) / 2, y);
    colour_ += (Vec2(middle.u - kGrey, middle.v - kGrey) - colour_) / ++rows;
    for (const double edge : {-0.5, 0.5}) {
      add(left - 0.5, y + edge);
      add(right + 0.5, y + edge);
    }
  }
  return !outline_.empty() && blob.area_px >= kSolid * static_cast<double>(within_px);
}

/// Whether the outline lies in a known obstacle's shadow, which is all that can be seen of it.
bool ObstacleFinder::is_outline_known() const {
  return std::ranges::any_of(rules_.known, [&](const Circle& known) {
    const Circle grown{known.centre_m, known.radius_m + kBeyond_m};
    const Uprights upright{{&grown, 1}, kHigh_m};
    return std::ranges::all_of(outline_, [&](const Vec2& point) { return hide(upright, point, camera_); });
  });
}

/// Of whatever height.
bool ObstacleFinder::is_known(const Circle& circle) const {
  return std::ranges::any_of(rules_.known, [&](const Circle& known) {
    return (known.centre_m - circle.centre_m).norm() + circle.radius_m <= known.radius_m + kBeyond_m;
  });
}

/// From below the camera, where all uprights run away from, the two lines of sight that touch it and its
/// nearest point say the circle. What is nearly below the camera is seen as it is.
Circle ObstacleFinder::circle_of_outline(const ImageView& image, const Uprights& robots) const {
  const Vec2 below_m = camera_.position_m().head<2>();
  Vec2 low = outline_[0], high = outline_[0];
  for (const Vec2& point : outline_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vec2 middle = 0.5 * (low + high), ahead = (middle - below_m).normalized();
  double near_m = (middle - below_m).norm(), around_m = 0, least_rad = 0, most_rad = 0;
  for (const Vec2& point : outline_) {
    const Vec2 seen = point - below_m;
    const double bearing_rad = std::atan2(cross(ahead, seen), ahead.dot(seen));
    least_rad = std::min(least_rad, bearing_rad);
    most_rad = std::max(most_rad, bearing_rad);
    near_m = std::min(near_m, seen.norm());
    around_m = std::max(around_m, (point - middle).norm());
  }
  const double half = std::sin(std::min(0.5 * (most_rad - least_rad), 0.5 * std::numbers::pi));
  if ((middle - below_m).norm() <= around_m || half > kNearlyBelow) return {middle, around_m};
  const SeenThing thing{rotated(ahead, 0.5 * (least_rad + most_rad)), near_m, 0.5 * (most_rad - least_rad),
                        colour_};
  near_m = near_with_shade_m(thing, camera_, image, robots);
  const double radius_m = near_m * half / (1 - half);
  return {below_m + (near_m + radius_m) * thing.ahead, radius_m};
}

std::span<const Circle> ObstacleFinder::find(const ImageView& image, const ColourClasses& classes,
                                             std::span<const Region> regions,
                                             std::span<const Circle> robots) {
  const Uprights hidden{robots, rules_.robot_height_m};
  found_.clear();
  obstacles_.clear();
  gather(regions, hidden);
  std::ranges::sort(blobs_, std::greater{}, &Blob::area_px);
  for (const Blob& blob : blobs_) {
    if (!is_large(blob) || !find_outline(blob, image, classes, hidden)) continue;
    if (is_outline_known()) {
      found_.push_back(blob);
      continue;
    }
    const Circle circle = circle_of_outline(image, hidden);
    if (circle.radius_m < rules_.least_radius_m) continue;
    found_.push_back(blob);
    if (!is_known(circle)) obstacles_.push_back(circle);
  }
  return obstacles_;
}

bool ObstacleFinder::is_part(const Region& region) const {
  return std::ranges::any_of(found_, [&](const Blob& blob) {
    const Region& whole = blob.largest;
    return region.left_px >= whole.left_px && region.right_px <= whole.right_px &&
           region.top_px >= whole.top_px && region.bottom_px <= whole.bottom_px;
  });
}

}  // namespace sidestep
