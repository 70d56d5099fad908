// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/geometry/circle.hpp"
#include "common/image/image.hpp"
#include "vision/detection/vertical.hpp"
#include "vision/segmentation/colour_classes.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

struct ObstacleRules {
  std::uint32_t ground = 0;      ///< bit c: colour c is none that an obstacle could have
  double largest_dot_m = 0.025;  ///< radius of the largest thing that is to have a named colour
  double least_radius_m = 0.03;  ///< what is smaller is no obstacle
  double robot_height_m = 0.15;
  std::vector<Circle> known;  ///< on the floor, that need not be found
};

/// Finds what stands on the floor and is neither robot nor ball, from regions of any colour: those that touch
/// make one thing, and it counts when it is too large for a dot or the ball. How high it is nobody knows, and
/// does not matter for what is round and stands upright: seen from below the camera it is as wide as it is on
/// the floor whatever its height, and its nearest point lies on the floor. What floats, or shows its colour
/// only on its top, is taken to lie farther away, and be larger, by its height over the camera's. What lies
/// in a known obstacle's shadow, as a lamp at the camera would cast it were it 0.3 m high, or makes a circle
/// within it, is that obstacle.
class ObstacleFinder {
 public:
  ObstacleFinder(const CameraModel& camera, const ObstacleRules& rules) : camera_(camera), rules_(rules) {}

  /// The largest first. What is seen on or behind one of `robots`, as wide as these circles from the floor to
  /// their tops, is theirs. Valid until the next call; allocates when there is more to see than ever before.
  std::span<const Circle> find(const ImageView& image, const ColourClasses& classes,
                               std::span<const Region> regions, std::span<const Circle> robots);

  /// Whether a region lies within the largest region of one of the obstacles of the last call, known ones
  /// included.
  bool is_part(const Region& region) const;

 private:
  /// Regions that touch.
  struct Blob {
    Region largest;
    int left_px, right_px, top_px, bottom_px;
    std::uint32_t area_px;
  };
  bool is_of_robot(const Region& region, const Uprights& robots) const;
  bool is_on_robot(const Vec2& pixel, const Uprights& robots) const;
  void gather(std::span<const Region> regions, const Uprights& robots);
  bool is_large(const Blob& blob) const;
  /// Its points on the floor where its colour ends on either side of each row; false when it is not solid.
  bool find_outline(const Blob& blob, const ImageView& image, const ColourClasses& classes,
                    const Uprights& robots);
  bool is_outline_known() const;
  bool is_known(const Circle& circle) const;
  Circle circle_of_outline(const ImageView& image, const Uprights& robots) const;

  CameraModel camera_;
  ObstacleRules rules_;
  std::vector<Blob> blobs_, found_;
  std::vector<Vec2> outline_;
  Vec2 colour_{0, 0};  ///< of what the outline is of: the mean U and V, less grey's
  std::vector<Circle> obstacles_;
};

}  // namespace sidestep
