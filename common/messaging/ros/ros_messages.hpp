// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "common/messaging/topics.hpp"

namespace sidestep::ros {

/// geometry_msgs/Twist: metres and radians per second; x forward, y left, z up.
struct Twist {
  std::array<double, 3> linear{}, angular{};
};

/// nav_msgs/Odometry: a pose in the frame `frame_id`, and a velocity in the robot's own frame.
struct Odometry {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame_id, child_frame_id;
  std::array<double, 3> position{};
  std::array<double, 4> orientation{0, 0, 0, 1};  ///< quaternion x, y, z, w
  std::array<double, 36> pose_covariance{};
  Twist twist;
  std::array<double, 36> twist_covariance{};
};

/// The DDS name of a robot base's ROS 2 topic: "rt/robot3/cmd_vel" for the prefix "robot".
std::string command_channel(const std::string& prefix, std::uint32_t robot);
std::string odometry_channel(const std::string& prefix, std::uint32_t robot);

/// Topic descriptions with ROS 2's type names. They are not in the topic table, because these messages lack
/// our headers: use Bus::relay() and Bus::observe_channel(). Best effort, so that readers match every writer.
extern const TopicInfo kTwist;
extern const TopicInfo kOdometry;
/// The same topic, but reliable, for writers: ROS 2's subscriptions request reliability by default.
TopicInfo reliable(TopicInfo topic);

}  // namespace sidestep::ros
