// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/log/log_event.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/counter_publisher.hpp"
#include "common/random/rng.hpp"
#include "simulator/world/cameras.hpp"
#include "simulator/world/disturbance_answers.hpp"
#include "simulator/world/lasers.hpp"
#include "simulator/world/world.hpp"
#include "simulator/world/world_event_logger.hpp"

namespace sidestep {

/// The simulator on a bus. It receives commands over a lossy radio and disturbances, which it answers,
/// advances the world to the bus's time, and publishes robots' reports, ground truth for metrics and audit,
/// and detections unless the scenario asks for images. The bus must make no callback after the node's
/// destruction.
class SimulatorNode {
 public:
  SimulatorNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, std::uint64_t seed);
  SimulatorNode(const SimulatorNode&) = delete;
  SimulatorNode& operator=(const SimulatorNode&) = delete;

  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent callback) {
    events_.set_listener(min_level, std::move(callback));
  }
  /// The node's event reporter, which its outputs also use.
  const EventReporter& events() const { return events_; }
  /// Registers a function that adds the drop counts of one of this node's outputs.
  void add_drop_source(std::function<void(DropCounters&)> source) {
    drop_sources_.push_back(std::move(source));
  }
  void count_drops(DropCounters& drops) const;

  /// Whether any robot obeys an agent. A restart of this process would make the robot forget the agent.
  bool is_commanded() const;

  /// Accepts no more versions, so all robots come to rest. Returns whether all rest and have been shown at
  /// rest, or have had twice the time that they need.
  [[nodiscard]] bool come_to_rest();
  /// The robots that move, or have a version that will move them.
  std::vector<RobotId> moving_robots();

  const World& world() const { return world_; }
  const Cameras& cameras() const { return cameras_; }
  /// Sets a callback that is called when a camera captures a frame, while the world is in the captured state.
  void set_capture_listener(std::function<void(std::uint32_t camera, Time captured_at)> listener) {
    capture_listener_ = std::move(listener);
  }
  /// Sets a callback that receives each frame's detections when they are due, even if the node does not
  /// publish them.
  void set_detection_listener(std::function<void(const msg::DetectionFrame&)> listener) {
    detection_listener_ = std::move(listener);
  }

 private:
  struct PendingFrame {
    bool is_waiting = false;
    Time publish_at{};
    msg::DetectionFrame message;
  };
  /// The current time of the world.
  Time clock();
  void at(Time world_time, std::function<void()> callback);
  void wake();
  void advance(Time now);
  void on_command(std::size_t robot, const msg::Command& message);
  void on_disturbance(const msg::Disturbance& message);
  /// Applies a disturbance, unless it is invalid or the robot's state does not allow it.
  msg::DisturbanceResult apply(const msg::Disturbance& message, Time now);
  void watch_start(std::size_t robot, Time now);
  void on_start(std::size_t robot);
  void publish_robot_report(std::size_t robot, Time now);
  void publish_pending_reports(Time now);
  void publish_truth(Time now);
  void capture_frame(Time now);
  void publish_frames();
  void publish_scan();

  Bus& bus_;
  Duration cycle_;
  Duration delay_;
  double command_loss_;
  bool publishes_detections_;
  Field field_;
  double radius_m_;
  Incarnation incarnation_;
  Duration max_stopping_time_;
  std::optional<Time> stopping_since_, resting_since_;  // by the bus's clock
  Time clock_;
  World world_;
  EventReporter events_;
  WorldEventLogger event_logger_{events_, world_};
  Cameras cameras_;
  std::optional<Lasers> lasers_;
  std::vector<Writer<msg::LaserScan>> scans_;  // for the robots with lasers
  msg::LaserScan scan_message_;
  Rng radio_rng_;
  DropCounters drops_;  // counts of lost commands and refused disturbances
  std::vector<std::function<void(DropCounters&)>> drop_sources_;

  std::unordered_map<RobotId, std::size_t> robot_index_;
  std::vector<Writer<msg::Feedback>> feedback_;
  std::vector<Time> report_due_;
  std::vector<Time> watched_start_;  ///< for each robot, the version start for which a timer is set
  Writer<msg::DetectionFrame> detections_;
  std::vector<PendingFrame> frames_;
  std::function<void(const msg::DetectionFrame&)> detection_listener_;
  std::function<void(std::uint32_t, Time)> capture_listener_;
  DisturbanceAnswers disturbance_answers_;
  Writer<msg::GroundTruth> truth_;
  msg::GroundTruth truth_message_;
  Time truth_due_;
  CounterPublisher counters_;
};

}  // namespace sidestep
