// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/collision/shapes.hpp"
#include "common/geometry/circle.hpp"
#include "common/image/image.hpp"
#include "common/map/floor_map.hpp"
#include "vision/detection/occlusion.hpp"
#include "vision/segmentation/colour_classes.hpp"
#include "vision/segmentation/region.hpp"

namespace sidestep {

/// Height of the dots on robots.
inline constexpr double kRobotHeight_m = 0.15;

struct ObstacleFinderSettings {
  std::uint32_t ground_colours = 0;           ///< bit c: colour c belongs to the ground, never to an obstacle
  double max_dot_radius_m = 0.025;            ///< radius of the largest dot or ball
  double min_radius_m = 0.03;                 ///< minimum radius of an obstacle
  std::vector<Shape> known_obstacles;         ///< not reported
  std::shared_ptr<const FloorMap> known_map;  ///< its blocked cells are not reported either; null: no map
};

/// Finds obstacles on the floor that are neither robot nor ball, from regions of any colour. Adjacent regions
/// form one blob; a blob counts if it is too large for a dot or the ball. The height of an obstacle is
/// unknown, but does not matter for a vertical cylinder: seen from the point below the camera, the cylinder
/// subtends the same angle as its base, and its nearest point lies on the floor. Objects that float, or show
/// their colour only on top, are estimated to be farther away and larger, by the ratio of their height to the
/// camera's. A blob is attributed to a known obstacle if it lies in the shadow that the obstacle would cast
/// from a lamp at the camera, or if its circle lies within the known one. Circles are assumed to be 0.3 m
/// high. Other shapes and map cells are assumed to be as high as robots, because long shadows could hide a
/// person.
class ObstacleFinder {
 public:
  ObstacleFinder(const CameraModel& camera, const ObstacleFinderSettings& settings)
      : camera_(camera), settings_(settings) {}

  /// Returns obstacles, largest first; the caller may reorder them. Ignores pixels on or behind a robot:
  /// `robots` contains the circles that the robots fill from the floor to their tops. Valid until the next
  /// call. Allocates only if a scene has more blobs or contour points than all earlier scenes.
  std::span<Circle> find(const ImageView& image, const ColourClasses& classes,
                         std::span<const Region> regions, std::span<const Circle> robots);

  /// Whether the last image had more blobs than the finder can handle, in which case obstacles may be
  /// missing.
  bool has_overflowed() const { return has_overflowed_; }
  /// Whether a region lies within the largest region of an obstacle found in the last call, including known
  /// obstacles.
  bool is_part_of_obstacle(const Region& region) const;

 private:
  /// A group of adjacent regions.
  struct Blob {
    Region largest;
    int left_px = 0, right_px = 0, top_px = 0, bottom_px = 0;
    std::uint32_t area_px = 0;
  };
  bool is_region_on_robot(const Region& region, const VerticalCylinders& robots) const;
  bool is_on_robot(const Vec2& pixel, const VerticalCylinders& robots) const;
  void collect_blobs(std::span<const Region> regions, const VerticalCylinders& robots);
  bool is_larger_than_dot(const Blob& blob) const;
  /// Fills contour_ with the ends of each row's coloured pixels, projected to the floor, and chroma_. False
  /// if the blob is not solid.
  bool find_contour(const Blob& blob, const ImageView& image, const ColourClasses& classes,
                    const VerticalCylinders& robots);
  bool is_in_known_shadow() const;
  bool is_in_shadow_of_floor(const Vec2& floor_m) const;
  bool is_within_known(const Circle& circle) const;
  Circle fit_circle(const ImageView& image, const VerticalCylinders& robots) const;

  CameraModel camera_;
  ObstacleFinderSettings settings_;
  std::vector<Blob> blobs_, found_;
  bool has_overflowed_ = false;
  std::vector<Vec2> contour_;
  Vec2 chroma_{0, 0};  ///< mean U and V inside the contour, relative to grey
  std::vector<Circle> obstacles_;
};

}  // namespace sidestep
