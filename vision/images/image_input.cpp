// SPDX-License-Identifier: Apache-2.0
#include "vision/images/image_input.hpp"

#include <fmt/core.h>
#include <utility>

namespace sidestep {

ImageInput::ImageInput(Bus& bus, ImageReader reader, VisionNode& to)
    : bus_(bus), reader_(std::move(reader)), node_(to) {
  bus.subscribe<msg::CameraImage>(topics::kImages, [this](const msg::CameraImage& image) { handle(image); });
}

void ImageInput::handle(const msg::CameraImage& image) {
  if (reader_.read(image, bus_.now(), node_.world(), frame_)) {
    node_.add_frame(frame_);
    return;
  }
  if (++rejected_ < next_report_) return;
  next_report_ *= 10;
  fmt::print(stderr,
             "sidestep-vision: {} image(s) rejected so far; latest: camera {}, {} x {} pixels, {} bytes\n",
             rejected_, image.camera(), image.width_px(), image.height_px(), image.pixels().size());
}

}  // namespace sidestep
