// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/velocity_server.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

constexpr Duration kOdometryPeriod = std::chrono::milliseconds(20);
constexpr double kMaxSpeed_mps = 100, kMaxTurn_radps = 1000;

}  // namespace

VelocityServer::VelocityServer(Bus& bus, VelocityRobotSimNode& node, const std::string& prefix, double drift)
    : bus_(bus), node_(node) {
  const BaseWorld& world = node.world_now();
  bases_.reserve(world.bodies().size());
  for (std::size_t i = 0; i < world.bodies().size(); ++i) {
    const RobotId id = world.floor().robots[i].id;
    Base& base = bases_.emplace_back();
    base.index = i;
    base.scale = i % 2 == 0 ? 1 + drift : 1 - drift;
    base.odometry = bus.relay(ros::reliable(ros::kOdometry), ros::odometry_channel(prefix, id));
    base.last_m = world.bodies()[i].position_m();
    base.last_rad = world.bodies()[i].heading_rad();
    bus.observe_channel<ros::Twist>(ros::kTwist, ros::command_channel(prefix, id),
                                    [this, &base](const ros::Twist& twist) { receive(base, twist); });
  }
  node.add_drop_source(
      [this](DropCounters& drops) { drops.count(DropReason::kMalformedCommand, std::nullopt, malformed_); });
  call_periodically(bus, kOdometryPeriod, [this] { publish(); });
}

void VelocityServer::receive(const Base& base, const ros::Twist& twist) {
  const bool is_valid = std::abs(twist.linear[0]) <= kMaxSpeed_mps &&
                        std::abs(twist.linear[1]) <= kMaxSpeed_mps &&
                        std::abs(twist.angular[2]) <= kMaxTurn_radps;
  if (!is_valid) {
    ++malformed_;
    return;
  }
  node_.world_now().command(base.index, {{twist.linear[0], twist.linear[1]}, twist.angular[2]},
                            node_.simulated_now());
}

void VelocityServer::publish() {
  const BaseWorld& world = node_.world_now();
  const std::int64_t now_ns = to_ns(bus_.now());
  for (Base& base : bases_) {
    const Body& body = world.bodies()[base.index];
    const double turned_rad = body.heading_rad() - base.last_rad;
    const Vec2 moved_m = rotated(Vec2(body.position_m() - base.last_m), -(base.last_rad + 0.5 * turned_rad));
    base.position_m += base.scale * rotated(moved_m, base.heading_rad + 0.5 * turned_rad);
    base.heading_rad += turned_rad;
    base.last_m = body.position_m();
    base.last_rad = body.heading_rad();
    ros::Odometry message;
    message.sec = static_cast<std::int32_t>(now_ns / 1'000'000'000);
    message.nanosec = static_cast<std::uint32_t>(now_ns % 1'000'000'000);
    message.frame_id = "odom";
    message.child_frame_id = "base_link";
    message.position = {base.position_m.x(), base.position_m.y(), 0};
    message.orientation = {0, 0, std::sin(base.heading_rad / 2), std::cos(base.heading_rad / 2)};
    const Vec2 velocity_mps = base.scale * rotated(body.velocity_mps(), -body.heading_rad());
    message.twist.linear = {velocity_mps.x(), velocity_mps.y(), 0};
    message.twist.angular = {0, 0, body.angular_radps()};
    base.odometry->write(&message);
  }
}

}  // namespace sidestep
