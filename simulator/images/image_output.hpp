// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/messaging/bus.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "simulator/world/simulator_node.hpp"

namespace sidestep {

/// Publishes the images of a simulator's cameras, rendered when they are due. The bus must make no callback
/// after this object's destruction.
class ImageOutput {
 public:
  /// Precondition: the scenario has images. Throws what camera_grid() throws.
  ImageOutput(Bus& bus, const Scenario& scenario, SimulatorNode& simulator, Incarnation incarnation,
              std::uint64_t seed);
  ImageOutput(const ImageOutput&) = delete;
  ImageOutput& operator=(const ImageOutput&) = delete;

 private:
  void publish(std::size_t camera, Time captured_at, const FloorScene& floor);

  Bus& bus_;
  Scenario scenario_;
  std::vector<FrameRenderer> renderers_;
  msg::CameraImage image_;
  Writer<msg::CameraImage> writer_;
};

}  // namespace sidestep
