// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {

/// Where a vision node gets its frames: detections on the bus, or calls of VisionNode::add_frame().
enum class FrameSource { kBus, kCaller };

/// The vision service on a bus: fuses frames and publishes the world state and the list of obstacles at the
/// cameras' rate, also when no frames arrive.
class VisionNode {
 public:
  /// Precondition: the bus makes no callbacks after the node's destruction.
  VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation,
             FrameSource source = FrameSource::kBus);
  VisionNode(const VisionNode&) = delete;
  VisionNode& operator=(const VisionNode&) = delete;

  /// The last published world.
  const msg::WorldState& world() const { return world_; }
  /// Processes a frame that has just arrived.
  void add_frame(const msg::DetectionFrame& message);
  /// The listener is called with every published world.
  void set_listener(std::function<void(const msg::WorldState&)> listener) { listener_ = std::move(listener); }

 private:
  void publish();

  Bus& bus_;
  Duration period_;
  Time next_;
  Frame frame_;
  Tracker tracker_;
  msg::WorldState world_;
  msg::ObstacleList obstacles_;
  Writer<msg::WorldState> world_writer_;
  Writer<msg::ObstacleList> obstacle_writer_;
  std::function<void(const msg::WorldState&)> listener_;
};

}  // namespace sidestep
