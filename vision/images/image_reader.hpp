// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "idl/vision.hpp"
#include "vision/colours/colour_file.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep {

/// The image in a message; nullopt if its size or format does not match its bytes or the camera.
[[nodiscard]] std::optional<ImageView> view_of(const msg::CameraImage& message, const CameraModel& camera);

/// Detector settings for a scenario. Each robot has the layout's pattern with its number; throws
/// std::invalid_argument if the layout lacks that pattern.
[[nodiscard]] DetectorSettings detector_settings(const Scenario& scenario,
                                                 const std::vector<ColourBox>& boxes,
                                                 const MarkerLayout& layout);

/// Runs detection on the images of all cameras of a scenario.
class ImageReader {
 public:
  /// `cameras` are indexed by their numbers in messages. Throws what detector_settings() throws.
  ImageReader(const Scenario& scenario, std::vector<CameraModel> cameras, const ColourThresholds& colours,
              const MarkerLayout& layout);

  /// Fills in the detections of an image: everything except the frame's header. Returns false and leaves the
  /// frame unchanged if the image is not timely or not from one of the cameras. `world` provides recent poses
  /// of the robots.
  bool read(const msg::CameraImage& message, Time now, const msg::WorldState& world,
            msg::DetectionFrame& frame);

  const Detector& detector(std::size_t camera) const { return detectors_[camera]; }
  const std::vector<CameraModel>& cameras() const { return cameras_; }

 private:
  std::vector<CameraModel> cameras_;
  PixelFormat format_;
  Duration max_lead_;
  std::vector<Detector> detectors_;
  std::vector<ExpectedRobot> expected_;
};

}  // namespace sidestep
