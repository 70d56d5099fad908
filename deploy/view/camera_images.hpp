// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/camera/camera_model.hpp"
#include "common/config/scenario.hpp"
#include "common/messaging/dds/bus.hpp"
#include "deploy/inspect/floor/floor_state.hpp"

namespace sidestep {

/// The images of a scenario's cameras, for viewers. Because images are large (about 100 MB/s), they are
/// received only while a viewer asks for them.
class CameraImages {
 public:
  /// The scenario must outlive this object.
  CameraImages(const Scenario& scenario, const DdsSettings& dds);

  /// The latest image of a camera as JPEG, with crosses where vision sees the robots. nullopt if there is no
  /// image yet or no such camera.
  [[nodiscard]] std::optional<std::string> jpeg(std::size_t camera, const FloorState& floor, Time now);
  /// Receives images that have arrived. Call it often.
  void poll(Time now);

 private:
  struct Camera {
    CameraModel model;
    std::optional<msg::CameraImage> image;
  };

  DdsSettings dds_;
  std::vector<Camera> cameras_;
  std::unique_ptr<DdsBus> bus_;  ///< null: no viewer has asked recently
  Time asked_at_{};
};

}  // namespace sidestep
