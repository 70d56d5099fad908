// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "common/messaging/bus.hpp"
#include "vision/images/image_reader.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep {

/// Feeds a vision node with detections from images on the bus, and reports rejected images.
/// Precondition: the bus makes no callbacks after this object's destruction.
class ImageInput {
 public:
  ImageInput(Bus& bus, ImageReader reader, VisionNode& to);
  ImageInput(const ImageInput&) = delete;
  ImageInput& operator=(const ImageInput&) = delete;

 private:
  void handle(const msg::CameraImage& image);

  Bus& bus_;
  ImageReader reader_;
  VisionNode& node_;
  msg::DetectionFrame frame_;
  std::uint64_t rejected_ = 0;
  std::uint64_t next_report_ = 1;  ///< value of rejected_ at which the next report is due
};

}  // namespace sidestep
