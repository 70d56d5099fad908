// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/collision/shapes.hpp"
#include "common/image/image.hpp"
#include "common/map/floor_map.hpp"
#include "idl/vision.hpp"
#include "vision/detection/obstacle_finder.hpp"
#include "vision/patterns/identifier.hpp"
#include "vision/patterns/pattern_finder.hpp"
#include "vision/segmentation/segmenter.hpp"

namespace sidestep {

inline constexpr Colour kBallColour = Colour::kOrange;

struct DetectorSettings {
  std::vector<ColourBox> boxes;  ///< colour numbers: those of Colour, or kOtherColour
  MarkerLayout layout;
  std::vector<RosterEntry> roster;
  double robot_radius_m = 0.09;
  std::vector<Shape> known_obstacles;         ///< not reported
  std::shared_ptr<const FloorMap> known_map;  ///< its blocked cells are not reported either; null: no map
};

/// Detects robots, balls and obstacles in the frames of one camera. Everything except robots, balls and the
/// ground is an obstacle (ObstacleFinder).
class Detector {
 public:
  Detector(const CameraModel& camera, const DetectorSettings& settings);

  /// Fills in the frame except its header and camera. `expected` contains predicted poses at the time of
  /// capture. Precondition: the image has the camera's size.
  void detect(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
              msg::DetectionFrame& frame);

  /// Regions of the last frame.
  std::span<const Region> regions() const { return regions_; }

 private:
  void find_robots(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                   msg::DetectionFrame& frame);
  double chroma_distance(Colour colour, const Vec2& uv) const;
  std::optional<Team> team_by_chroma(const ImageView& image, const Vec2& centre_m) const;
  bool is_robot_dot(const ProjectedRegion& region) const;
  void find_balls(msg::DetectionFrame& frame);
  void find_obstacles(const ImageView& image, std::span<const ExpectedRobot> expected,
                      msg::DetectionFrame& frame);

  CameraModel camera_;
  DetectorSettings settings_;
  Segmenter segmenter_;
  PatternFinder pattern_finder_;
  Identifier identifier_;
  std::uint32_t marking_colours_;  ///< bit c: colour c occurs in the layout
  ObstacleFinder obstacle_finder_;
  std::span<const Region> regions_;
  std::vector<DetectedPattern> patterns_;
  std::span<const IdentifiedRobot> robots_;
  std::vector<ProjectedRegion> dot_regions_;
  std::vector<ProjectedRegion> ball_regions_;
  std::vector<Circle> footprints_;
};

}  // namespace sidestep
