// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "idl/vision.h"
#include "vision/colours/colour_file.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep {

/// The image that a message holds; nothing when its size or format does not fit its bytes or the camera.
std::optional<ImageView> view_of(const msg::CameraImage& message, const CameraModel& camera);

/// What a scenario's cameras look for. Its robots wear the layout's pattern of their number; throws
/// std::invalid_argument when a robot's number has none.
FrameTask frame_task(const Scenario& scenario, const std::vector<ColourBox>& boxes,
                     const MarkingLayout& layout);

/// Reads the images of all cameras of a scenario.
class ImageReader {
 public:
  /// `cameras` go by their numbers in messages. Throws as frame_task() does.
  ImageReader(const Scenario& scenario, std::vector<CameraModel> cameras, const ColourThresholds& colours,
              const MarkingLayout& layout);

  /// What the image shows; all is set but the head. False, and nothing done, for an image that no camera here
  /// makes now. `world` says where robots were lately.
  bool read(const msg::CameraImage& message, Time now, const msg::WorldState& world,
            msg::DetectionFrame& frame);

  /// The camera's reader, and what it knows of its last image.
  const Detector& camera(std::size_t number) const { return readers_[number]; }
  const std::vector<CameraModel>& cameras() const { return cameras_; }

 private:
  std::vector<CameraModel> cameras_;
  PixelFormat format_;
  std::vector<Detector> readers_;
  std::vector<ExpectedRobot> expected_;
};

}  // namespace sidestep
