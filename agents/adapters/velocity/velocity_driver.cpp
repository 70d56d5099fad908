// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/velocity/velocity_driver.hpp"

#include <cmath>

namespace sidestep {
namespace {

// If a base's clock is off by more than this, it keeps a different time, for example simulated time. In that
// case its odometry is timestamped on arrival.
constexpr Duration kMaxClockError = std::chrono::seconds(1);
// Odometry counts from any origin, which need not be the field's.
constexpr double kMaxOdometry_m = 1e6;
constexpr double kMaxNormError = 0.1;

bool is_coordinate(double x) { return std::abs(x) <= kMaxOdometry_m; }

}  // namespace

VelocityDriver::VelocityDriver(Bus& bus, const std::vector<RobotId>& robots, const std::string& prefix)
    : bus_(bus) {
  for (const RobotId robot : robots) {
    writers_[robot] = bus.relay(ros::reliable(ros::kTwist), ros::command_channel(prefix, robot));
    bus.observe_channel<ros::Odometry>(
        ros::kOdometry, ros::odometry_channel(prefix, robot),
        [this, robot](const ros::Odometry& message) { receive(robot, message); });
  }
}

void VelocityDriver::send(std::span<const BaseCommand> commands) {
  for (const BaseCommand& command : commands) {
    ros::Twist twist;
    twist.linear = {command.velocity.linear_mps.x(), command.velocity.linear_mps.y(), 0};
    twist.angular = {0, 0, command.velocity.turn_radps};
    writers_.at(command.robot)->write(&twist);
  }
}

void VelocityDriver::receive(RobotId robot, const ros::Odometry& message) {
  const auto& [x, y, z, w] = message.orientation;
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);
  // False for a NaN.
  const bool is_valid = is_coordinate(message.position[0]) && is_coordinate(message.position[1]) &&
                        std::abs(norm - 1) <= kMaxNormError;
  if (!is_valid) {
    ++malformed_[robot];
    return;
  }
  const Time now = bus_.now();
  const Time stamp = time_from_ns(std::int64_t{message.sec} * 1'000'000'000 + message.nanosec);
  OdometryReport report;
  report.robot = robot;
  report.measured_at = std::chrono::abs(now - stamp) <= kMaxClockError ? stamp : now;
  report.position_m = {message.position[0], message.position[1]};
  report.heading_rad = std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  if (callback_) callback_(report);
}

void VelocityDriver::count_drops(DropCounters& drops) const {
  for (const auto& [robot, count] : malformed_) drops.count(DropReason::kMalformedOdometry, robot, count);
}

}  // namespace sidestep
