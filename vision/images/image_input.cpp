// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_input.hpp"

#include <utility>

namespace sidestep {

ImageInput::ImageInput(Bus& bus, ImageReader reader, VisionNode& to)
    : bus_(bus), reader_(std::move(reader)), node_(to) {
  node_.add_drop_source(
      [this](DropCounters& drops) { drops.count(DropReason::kMalformedImage, std::nullopt, rejected_); });
  bus.subscribe<msg::CameraImage>(topics::kImages, [this](const msg::CameraImage& image) { handle(image); });
}

void ImageInput::handle(const msg::CameraImage& image) {
  if (reader_.read(image, bus_.now(), node_.world(), frame_)) {
    node_.add_frame(frame_);
    return;
  }
  if (++rejected_ < next_report_) return;
  next_report_ *= 10;
  node_.events().report(LogLevel::kWarning, {},
                        "{} image(s) rejected so far; latest: camera {}, {} x {} pixels, {} bytes", rejected_,
                        image.camera(), image.width_px(), image.height_px(), image.pixels().size());
}

}  // namespace sidestep
