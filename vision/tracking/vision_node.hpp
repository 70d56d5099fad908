// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"
#include "vision/tracking/camera_handovers.hpp"
#include "vision/tracking/camera_offsets.hpp"
#include "vision/tracking/camera_watch.hpp"
#include "vision/tracking/tracker.hpp"
#include "vision/tracking/vision_event_logger.hpp"

namespace sidestep {

/// The source of a vision node's frames: detections on the bus, or calls of VisionNode::add_frame().
enum class FrameSource { kBus, kCaller };

/// The numbers of a scenario's cameras: 0 .. columns * rows - 1.
[[nodiscard]] std::vector<std::uint32_t> cameras_of(const VisionSpec& vision);

/// The vision service on a bus: fuses frames, and publishes the world state and the list of obstacles at the
/// cameras' rate, even if no frames arrive.
class VisionNode {
 public:
  /// `cameras` are the numbers of the cameras that together see the whole floor; frames of other cameras are
  /// refused. Precondition: the bus makes no callbacks after the node's destruction.
  VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, FrameSource source,
             const std::vector<std::uint32_t>& cameras);
  /// Uses the scenario's cameras.
  VisionNode(Bus& bus, const Scenario& scenario, Incarnation incarnation,
             FrameSource source = FrameSource::kBus)
      : VisionNode(bus, scenario, incarnation, source, cameras_of(scenario.vision)) {}
  VisionNode(const VisionNode&) = delete;
  VisionNode& operator=(const VisionNode&) = delete;

  /// The last published world.
  const msg::WorldState& world() const { return world_; }
  /// Processes a frame that has just arrived. `date_uncertainty` is the maximum error of its capture time
  /// beyond the clock bound.
  void add_frame(const msg::DetectionFrame& message, Duration date_uncertainty = Duration{0});
  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  /// The node's event reporter, which the sources of its frames also use.
  const EventReporter& events() const { return events_; }
  /// Registers a function that adds the drop counts of a source of this node's frames.
  void add_drop_source(std::function<void(DropCounters&)> source) {
    drop_sources_.push_back(std::move(source));
  }
  void count_drops(DropCounters& drops) const;
  /// The listener is called with every published world.
  void set_listener(std::function<void(const msg::WorldState&)> listener) { listener_ = std::move(listener); }

 private:
  void publish();
  /// Resets the tracker and the camera watch after this process's clock was set back, because new frames
  /// would seem older than earlier ones.
  void on_clock_set_back(Duration by);

  Bus& bus_;
  Duration period_;
  Time next_;
  Duration max_lead_;  // maximum lead of a frame's capture time
  Frame frame_;
  CameraOffsets offsets_;
  Tracker tracker_;
  CameraHandovers handovers_;
  CameraWatch watch_;
  msg::WorldState world_;
  msg::ObstacleList obstacles_;
  Writer<msg::WorldState> world_writer_;
  Writer<msg::ObstacleList> obstacle_writer_;
  std::function<void(const msg::WorldState&)> listener_;
  EventReporter events_;
  VisionEventLogger event_logger_;
  std::uint64_t unknown_cameras_ = 0;  // number of frames from cameras that are not configured
  std::vector<std::function<void(DropCounters&)>> drop_sources_;
  CounterPublisher counters_;
};

}  // namespace sidestep
