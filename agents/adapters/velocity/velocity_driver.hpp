// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "agents/adapters/driver.hpp"
#include "common/messaging/bus.hpp"
#include "common/messaging/ros/ros_messages.hpp"

namespace sidestep {

/// Drives bases by velocity commands over DDS, with ROS 2's names and types: twists on rt/robot3/cmd_vel,
/// odometry from rt/robot3/odom. A base must be able to drive in any direction (linear.x and linear.y).
class VelocityDriver : public Driver {
 public:
  /// `prefix` is for example "robot" for rt/robot3/cmd_vel. The bus must make no callback after the driver's
  /// destruction.
  VelocityDriver(Bus& bus, const std::vector<RobotId>& robots, const std::string& prefix);

  void send(std::span<const BaseCommand> commands) override;
  void on_odometry(std::function<void(const OdometryReport&)> callback) override {
    callback_ = std::move(callback);
  }
  void count_drops(DropCounters& drops) const override;

 private:
  void receive(RobotId robot, const ros::Odometry& message);

  Bus& bus_;
  std::map<RobotId, std::unique_ptr<RawWriter>> writers_;
  std::function<void(const OdometryReport&)> callback_;
  std::map<RobotId, std::uint64_t> malformed_;
};

}  // namespace sidestep
