// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/messaging/bus.hpp"
#include "common/messaging/ros/ros_messages.hpp"
#include "simulator/bases/velocity_robot_sim_node.hpp"

namespace sidestep {

/// Makes the bases of a simulated floor available on ROS 2's topics: receives twists, and publishes odometry
/// 50 times a second. The bus must make no callback after the server's destruction.
class VelocityServer {
 public:
  /// A base's odometry overestimates its motion by the fraction `drift`; for every second base it
  /// underestimates the motion by the same fraction.
  VelocityServer(Bus& bus, VelocityRobotSimNode& node, const std::string& prefix, double drift);
  VelocityServer(const VelocityServer&) = delete;
  VelocityServer& operator=(const VelocityServer&) = delete;

 private:
  struct Base {
    std::size_t index = 0;  ///< index in the world
    double scale = 1;
    std::unique_ptr<RawWriter> odometry;
    Vec2 last_m{0, 0};  ///< position in the world at the last report
    double last_rad = 0;
    Vec2 position_m{0, 0};  ///< according to odometry, in a frame whose origin is the base's start
    double heading_rad = 0;
  };
  void receive(const Base& base, const ros::Twist& twist);
  void publish();

  Bus& bus_;
  VelocityRobotSimNode& node_;
  std::vector<Base> bases_;
  std::uint64_t malformed_ = 0;
};

}  // namespace sidestep
