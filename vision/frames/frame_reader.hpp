// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/image/image.hpp"
#include "idl/vision.h"
#include "vision/patterns/identifier.hpp"
#include "vision/patterns/pattern_finder.hpp"
#include "vision/segmentation/segmenter.hpp"

namespace sidestep {

/// What cameras look for.
struct FrameTask {
  std::vector<ColourBox> boxes;  ///< of Colours, by their numbers
  MarkingLayout layout;
  std::vector<RosterEntry> roster;
  double robot_height_m = 0.15;
  double ball_radius_m = 0.0215;
  Colour ball = Colour::kOrange;
  double least_obstacle_m = 0.03;  ///< radius below which a patch of an unknown colour is no obstacle
};

/// Reads one camera's frames: robots by their dots, balls, and as obstacles what has a colour that nobody
/// wears.
class FrameReader {
 public:
  FrameReader(const CameraModel& camera, const FrameTask& task);

  /// Sets all but the head and the camera. `expected` is where robots are taken to be when the frame is
  /// captured. Precondition: the image has the camera's size.
  void read(const ImageView& image, Time captured_at, std::span<const ExpectedRobot> expected,
            msg::DetectionFrame& frame);

  /// Of the last frame.
  std::span<const Region> regions() const { return regions_; }
  std::span<const IdentifiedRobot> robots() const { return robots_; }

 private:
  bool is_worn(Colour colour) const;
  bool is_dot(const Patch& patch) const;
  void find_balls(msg::DetectionFrame& frame);
  void find_obstacles(msg::DetectionFrame& frame) const;

  CameraModel camera_;
  FrameTask task_;
  Segmenter segmenter_;
  PatternFinder finder_;
  Identifier identifier_;
  std::span<const Region> regions_;
  std::span<const IdentifiedRobot> robots_;
  std::vector<Patch> patches_;
  std::vector<Patch> balls_;
};

}  // namespace sidestep
