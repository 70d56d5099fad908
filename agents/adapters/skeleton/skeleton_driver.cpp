// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/skeleton/skeleton_driver.hpp"

#include <algorithm>

namespace sidestep {

SkeletonDriver::SkeletonDriver(const std::vector<RobotId>& robots, std::function<Time()> now)
    : now_(std::move(now)) {
  // Open the connection to your bases here. Throw std::invalid_argument if an option is wrong, and
  // std::runtime_error if the connection cannot be opened.
  for (const RobotId robot : robots) bases_.push_back({{robot, now_(), {0, 0}, 0}, {}});
}

void SkeletonDriver::send(std::span<const BaseCommand> commands) {
  const Time now = now_();
  for (const BaseCommand& command : commands) {
    // Send command.velocity to the base of command.robot here, without waiting. The code below simulates what
    // a base does:
    const auto base =
        std::ranges::find_if(bases_, [&](const Base& one) { return one.odometry.robot == command.robot; });
    if (base == bases_.end()) continue;
    OdometryReport& odometry = base->odometry;
    const double elapsed_s = to_seconds(now - odometry.measured_at);
    const double turn_rad = elapsed_s * base->velocity.turn_radps;
    odometry.position_m +=
        elapsed_s * rotated(base->velocity.linear_mps, odometry.heading_rad + turn_rad / 2);
    odometry.heading_rad += turn_rad;
    odometry.measured_at = now;
    base->velocity = command.velocity;
    // When a base reports its odometry, check that its numbers are finite, and pass it on:
    if (callback_) callback_(odometry);
  }
}

void SkeletonDriver::on_odometry(std::function<void(const OdometryReport&)> callback) {
  callback_ = std::move(callback);
}

const OdometryReport& SkeletonDriver::base(RobotId robot) const {
  return std::ranges::find_if(bases_, [&](const Base& one) { return one.odometry.robot == robot; })->odometry;
}

}  // namespace sidestep
