// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {

/// Who brings a vision node its frames: the bus's cameras, or somebody else by VisionNode::take().
enum class FrameSource { kBus, kCaller };

/// The vision service on a bus: frames in, one world state out at the cameras' rate, whether frames come or
/// not.
class VisionNode {
 public:
  /// The bus must not call back any more when the node has gone.
  VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation,
             FrameSource source = FrameSource::kBus);
  VisionNode(const VisionNode&) = delete;
  VisionNode& operator=(const VisionNode&) = delete;

  /// What was published last.
  const msg::WorldState& world() const { return world_; }
  /// A frame that has just come.
  void take(const msg::DetectionFrame& message);
  /// Gives the listener every world that is published.
  void set_listener(std::function<void(const msg::WorldState&)> listener) { listener_ = std::move(listener); }

 private:
  void publish();

  Bus& bus_;
  Duration period_;
  Time next_;
  Frame frame_;
  Tracker tracker_;
  msg::WorldState world_;
  Writer<msg::WorldState> writer_;
  std::function<void(const msg::WorldState&)> listener_;
};

}  // namespace sidestep
