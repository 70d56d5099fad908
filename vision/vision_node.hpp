// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "vision/tracking/tracker.hpp"

namespace sidestep {

/// The vision service on a bus: frames in, one world state out at the cameras' rate, whether frames come or
/// not.
class VisionNode {
 public:
  /// The bus must not call back any more when the node has gone.
  VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation);
  VisionNode(const VisionNode&) = delete;
  VisionNode& operator=(const VisionNode&) = delete;

 private:
  void publish();

  Bus& bus_;
  Duration period_;
  Time next_;
  Frame frame_;
  Tracker tracker_;
  msg::WorldState world_;
  Writer<msg::WorldState> writer_;
};

}  // namespace sidestep
