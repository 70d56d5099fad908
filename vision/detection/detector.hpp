// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "idl/vision.h"
#include "vision/detection/obstacle_finder.hpp"
#include "vision/patterns/identifier.hpp"
#include "vision/patterns/pattern_finder.hpp"
#include "vision/segmentation/segmenter.hpp"

namespace sidestep {

/// What cameras look for.
struct FrameTask {
  std::vector<ColourBox> boxes;  ///< of Colours, by their numbers, and of kOtherColour
  MarkingLayout layout;
  std::vector<RosterEntry> roster;
  double robot_radius_m = 0.09;
  double robot_height_m = 0.15;
  double ball_radius_m = 0.0215;
  Colour ball = Colour::kOrange;
  double least_obstacle_m = 0.03;       ///< radius below which nothing is an obstacle
  std::vector<Circle> known_obstacles;  ///< that need not be told
};

/// Reads one camera's frames: robots by their dots, balls, and as obstacles what else is not the ground
/// (ObstacleFinder).
class Detector {
 public:
  Detector(const CameraModel& camera, const FrameTask& task);

  /// Sets all but the head and the camera. `expected` is where robots are taken to be when the frame is
  /// captured. Precondition: the image has the camera's size.
  void read(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
            msg::DetectionFrame& frame);

  /// Of the last frame.
  std::span<const Region> regions() const { return regions_; }
  std::span<const IdentifiedRobot> robots() const { return robots_; }

 private:
  void find_robots(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
                   msg::DetectionFrame& frame);
  double distance_from(Colour colour, const Vec2& uv) const;
  std::optional<Team> team_at(const ImageView& image, const Vec2& centre_m) const;
  bool is_dot(const Patch& patch) const;
  void find_balls(msg::DetectionFrame& frame);
  void find_obstacles(const ImageView& image, std::span<const ExpectedRobot> expected,
                      msg::DetectionFrame& frame);

  CameraModel camera_;
  FrameTask task_;
  Segmenter segmenter_;
  PatternFinder finder_;
  Identifier identifier_;
  std::uint32_t worn_;  ///< bit c: colour c is on somebody's dots
  ObstacleFinder obstacle_finder_;
  std::span<const Region> regions_;
  std::vector<MarkedRobot> marked_;
  std::span<const IdentifiedRobot> robots_;
  std::vector<Patch> patches_;
  std::vector<Patch> balls_;
  std::vector<Circle> feet_;
};

}  // namespace sidestep
