// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "common/image/image.hpp"
#include "common/marking/colours.hpp"
#include "vision/segmentation/colour_classes.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

struct FloorBlobSettings {
  Colour robot = Colour::kBlue;     ///< colour of the dot that marks the robot
  Colour target = Colour::kOrange;  ///< colour of the target
  std::uint32_t ground_colours =
      1U << static_cast<unsigned>(Colour::kField) | 1U << static_cast<unsigned>(Colour::kWhite) |
      1U << static_cast<unsigned>(Colour::kBlack);  ///< bit c: colour c is ground, so no obstacle has it
  Vec2 below_camera_px{0, 0};                       ///< pixel of the floor point below the camera
  /// Distance of the highest obstacle's foot from below_camera_px, as a fraction of its top's distance,
  /// because its side may be too dark to be seen. 1: obstacles are flat.
  double foot_distance_ratio = 1;
};

/// An obstacle in the image. All its pixels and their feet lie in the diamond and in the disc. Pixels are
/// squares around their coordinates.
struct ObstacleBlob {
  int left_px = 0, right_px = 0, top_px = 0, bottom_px = 0;  ///< bounding box of its pixels, inclusive
  std::uint32_t area_px = 0;
  std::array<Vec2, 4> diamond{Vec2(0, 0), Vec2(0, 0), Vec2(0, 0),
                              Vec2(0, 0)};  ///< sides along the diagonals of the image
  Vec2 centre{0, 0};                        ///< centre of the disc
  double radius_px = 0;
};

/// The contents of a camera image of a floor.
struct FloorBlobs {
  std::vector<ObstacleBlob> obstacles;
  std::optional<Vec2> robot, target;  ///< centroids in pixels; nullopt: none or several found
};

/// Finds obstacles, robot and target among the colour regions of an image. Adjacent regions form one obstacle
/// whatever their colours. Reuses its memory between images.
class FloorBlobFinder {
 public:
  explicit FloorBlobFinder(const FloorBlobSettings& settings = {}) : settings_(settings) {}

  /// The result is valid until the next call.
  const FloorBlobs& find(const ImageView& image, const ColourClasses& classes,
                         std::span<const Region> regions);

  /// The pixel of the floor point below the object that a pixel shows, if the object is as high as an
  /// obstacle can be.
  Vec2 foot_of(const Vec2& pixel) const {
    return settings_.below_camera_px + settings_.foot_distance_ratio * (pixel - settings_.below_camera_px);
  }
  /// Whether a pixel has an obstacle's colour.
  bool is_obstacle(const Yuv& pixel, const ColourClasses& classes) const;

 private:
  std::optional<Vec2> robot(std::span<const Region> regions) const;
  std::optional<Vec2> target(const ImageView& image, const ColourClasses& classes,
                             std::span<const Region> regions) const;
  bool has_marker_size(const Region& region) const {
    return region.area_px >= kMinMarker_px && region.area_px <= kMaxMarker_px;
  }
  bool is_isolated(const ImageView& image, const ColourClasses& classes, const Region& region) const;
  void collect(std::span<const Region> regions);
  void measure(const ImageView& image, const ColourClasses& classes, ObstacleBlob& blob) const;

  static constexpr std::uint32_t kMinMarker_px = 4;   // minimum area of the robot's dot and of the target
  static constexpr std::uint32_t kMaxMarker_px = 80;  // a larger region is an obstacle
  // Pixels nearer than this to the robot's dot belong to the robot.
  static constexpr double kMaxRobot_px = 20;

  FloorBlobSettings settings_;
  FloorBlobs found_;
};

}  // namespace sidestep
