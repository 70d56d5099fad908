// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"
#include "simulator/bases/base_world.hpp"
#include "simulator/bases/simulated_clock.hpp"
#include "simulator/bases/start_places.hpp"
#include "simulator/world/cameras.hpp"

namespace sidestep {

/// A simulation of robots without firmware, beyond what its scenario says.
struct BaseFloorSettings {
  BaseSettings bases{};
  std::uint32_t team_size = 0;  ///< opponents are added until each team has this many robots
  StartPlaces starts = StartPlaces::kScenario;
  PaceSettings pace{};
  double camera_error_m = 0;  ///< see Cameras
};

/// Simulates a floor of robots that external programs drive. Advances the floor with the bus's time, and
/// publishes the cameras' detections after the scenario's delay, and ground truth for metrics and audit. The
/// bus must make no callback after the node's destruction.
class VelocityRobotSimNode {
 public:
  /// Throws what BaseWorld() and place_robots() throw.
  VelocityRobotSimNode(Bus& bus, const Scenario& scenario, const BaseFloorSettings& settings,
                       Incarnation incarnation, std::uint64_t seed);
  VelocityRobotSimNode(const VelocityRobotSimNode&) = delete;
  VelocityRobotSimNode& operator=(const VelocityRobotSimNode&) = delete;

  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  const EventReporter& events() const { return events_; }
  void add_drop_source(std::function<void(DropCounters&)> source) {
    drop_sources_.push_back(std::move(source));
  }
  /// Sets a callback that receives each frame's detections when they are due, and the simulated time of their
  /// capture. The capture times in frames are by the process's clock.
  void set_detection_listener(std::function<void(const msg::DetectionFrame&, Time simulated)> listener) {
    detection_listener_ = std::move(listener);
  }

  /// Advances the floor to the present and returns it.
  BaseWorld& world_now();
  Time simulated_now() { return clock_.simulated(bus_.now()); }
  Time simulated_begin() const { return begin_; }
  void set_speed(double speed) { clock_.set_speed(speed, bus_.now()); }
  const Cameras& cameras() const { return cameras_; }

 private:
  struct PendingFrame {
    Time captured_at{}, publish_at{};  ///< in simulated time
    msg::DetectionFrame message;
  };
  /// The end of a robot's latest disturbance. It is converted to real time only once, because the clock
  /// forgets the speeds of long ago.
  struct DatedDisturbance {
    std::int64_t simulated_ns = -1, real_ns = -1;
  };
  void wake();
  void capture();
  void publish_frames();
  void publish_truth();
  void report_contacts();

  Bus& bus_;
  Duration delay_;
  Incarnation incarnation_;
  Time begin_;
  SimulatedClock clock_;
  BaseWorld world_;
  Cameras cameras_;
  EventReporter events_;
  std::vector<std::function<void(DropCounters&)>> drop_sources_;
  std::function<void(const msg::DetectionFrame&, Time)> detection_listener_;
  std::vector<PendingFrame> frames_;  ///< in ascending order of publish_at
  Writer<msg::DetectionFrame> detections_;
  Writer<msg::GroundTruth> truth_;
  msg::GroundTruth truth_message_;
  std::unordered_map<RobotId, DatedDisturbance> disturbances_;
  Time truth_due_;
  Time advanced_at_;  ///< real time at which the floor was last advanced
  std::uint64_t reported_contacts_ = 0;
  CounterPublisher counters_;
};

}  // namespace sidestep
