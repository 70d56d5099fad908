// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "common/random/rng.hpp"
#include "simulator/cameras.hpp"
#include "simulator/world.hpp"

namespace sidestep {

/// The simulator as a process of the system: takes commands over a lossy radio, moves the world to the bus's
/// time, does to robots what disturbances say, and publishes robots' facts, detections unless the scenario
/// wants images, and truth for judges. Whoever owns the bus stops it before this goes.
class SimulatorNode {
 public:
  SimulatorNode(Bus& bus, const Scenario& scenario, Incarnation incarnation, std::uint64_t seed);
  SimulatorNode(const SimulatorNode&) = delete;
  SimulatorNode& operator=(const SimulatorNode&) = delete;

  const World& world() const { return world_; }
  const Cameras& cameras() const { return cameras_; }
  /// Calls back when a camera takes a frame of the world as it is then.
  void set_capture_listener(std::function<void(std::uint32_t camera, Time captured_at)> listener) {
    capture_listener_ = std::move(listener);
  }
  /// Gives the listener every frame's detections when they are due, published or not.
  void set_listener(std::function<void(const msg::DetectionFrame&)> listener) {
    listener_ = std::move(listener);
  }
  /// Commands that the radio lost.
  std::uint64_t commands_lost() const { return commands_lost_; }
  /// Disturbances that made no sense, or could not be done to that robot.
  std::uint64_t disturbances_refused() const { return disturbances_refused_; }

 private:
  struct Frame {
    bool is_waiting = false;
    Time publish_at{};
    msg::DetectionFrame message;
  };
  Time clock();
  void wake();
  void advance(Time now);
  void on_command(std::size_t robot, const msg::Command& command);
  void on_disturbance(const msg::Disturbance& what);
  void watch_start(std::size_t robot, Time now);
  void on_start(std::size_t robot);
  void publish_feedback(std::size_t robot, Time now);
  void publish_news(Time now);
  void publish_truth(Time now);
  void take_frame(Time now);
  void publish_frames();

  Bus& bus_;
  Duration cycle_;
  Duration delay_;
  double command_loss_;
  bool publishes_detections_;
  Field field_;
  double radius_m_;
  Incarnation incarnation_;
  Time clock_;
  World world_;
  Cameras cameras_;
  Rng radio_;
  std::uint64_t commands_lost_ = 0;
  std::uint64_t disturbances_refused_ = 0;

  std::unordered_map<RobotId, std::size_t> index_of_;
  std::vector<Writer<msg::Feedback>> feedback_;
  std::vector<Time> feedback_due_;
  std::vector<Time> watched_start_;  ///< of each robot's version that a timer waits for
  Writer<msg::DetectionFrame> detections_;
  std::vector<Frame> frames_;
  std::function<void(const msg::DetectionFrame&)> listener_;
  std::function<void(std::uint32_t, Time)> capture_listener_;
  Writer<msg::GroundTruth> truth_;
  msg::GroundTruth truth_message_;
  Time truth_due_;
};

}  // namespace sidestep
