// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "common/messaging/bus.hpp"
#include "vision/images/image_reader.hpp"
#include "vision/vision_node.hpp"

namespace sidestep {

/// Feeds a vision node with what the bus's images show, and says on stderr which images it cannot use. The
/// bus must not call back any more when this has gone.
class ImageInput {
 public:
  ImageInput(Bus& bus, ImageReader reader, VisionNode& to);
  ImageInput(const ImageInput&) = delete;
  ImageInput& operator=(const ImageInput&) = delete;

  /// Images that no camera of the scenario makes, or made long ago.
  std::uint64_t refused() const { return refused_; }

 private:
  void take(const msg::CameraImage& image);

  Bus& bus_;
  ImageReader reader_;
  VisionNode& node_;
  msg::DetectionFrame frame_;
  std::uint64_t refused_ = 0;
  std::uint64_t next_report_ = 1;
};

}  // namespace sidestep
