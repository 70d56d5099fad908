// SPDX-License-Identifier: Apache-2.0
#include "simulator/images/image_output.hpp"

#include <memory>

#include "common/camera/camera_grid.hpp"
#include "common/marking/butterfly.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

constexpr Duration kMaxLateness{200'000'000};

}  // namespace

ImageOutput::ImageOutput(Bus& bus, const Scenario& scenario, SimulatorNode& simulator,
                         Incarnation incarnation, std::uint64_t seed)
    : bus_(bus), scenario_(scenario), writer_(bus.advertise(topics::kImages)) {
  const ImageSpec& images = scenario.vision.images.value();
  RenderSpec spec;
  spec.format = images.format;
  Rng rng(seed);
  for (const CameraModel& camera : camera_grid(scenario))
    renderers_.emplace_back(camera, scenario.field, butterfly(), spec, Rng(rng.bits()),
                            static_scene(scenario));
  image_.header().sender(static_cast<std::uint32_t>(Sender::kSimulator));
  image_.header().incarnation(incarnation);
  image_.image_format(images.format == PixelFormat::kRgb ? msg::ImageFormat::IMAGE_RGB
                                                         : msg::ImageFormat::IMAGE_YUV422);
  image_.width_px(static_cast<std::uint32_t>(images.width_px));
  image_.height_px(static_cast<std::uint32_t>(images.height_px));
  image_.pixels().resize(ImageView{images.format, images.width_px, images.height_px}.bytes());
  simulator.set_capture_listener([this, &simulator](std::uint32_t camera, Time captured_at) {
    const auto floor = std::make_shared<FloorScene>(floor_scene(scenario_, simulator.world()));
    bus_.at(captured_at + scenario_.vision.delay,
            [this, camera, captured_at, floor] { publish(camera, captured_at, *floor); });
  });
}

void ImageOutput::publish(std::size_t camera, Time captured_at, const FloorScene& floor) {
  if (captured_at + scenario_.vision.delay + kMaxLateness < bus_.now()) return;
  renderers_[camera].render(floor.scene(), image_.pixels().data());
  image_.camera(static_cast<std::uint32_t>(camera));
  image_.captured_at_ns(to_ns(captured_at));
  writer_.publish(image_, bus_.now());
}

}  // namespace sidestep
