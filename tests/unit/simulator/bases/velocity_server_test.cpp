// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/velocity_server.hpp"

#include <limits>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::velocity_server_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

TEST_CASE("a base obeys twists and reports its motion with drift, in a frame whose origin is its start") {
  Scenario scenario;
  scenario.robots.emplace_back();
  scenario.robots.front().start_m = {1, 1};
  scenario.robots.front().start_heading_rad = 2;
  SimNetwork network(1, kBegin, {});
  SimBus bus(network), client(network);
  VelocityRobotSimNode node(bus, scenario, {}, 1, 1);
  const VelocityServer server(bus, node, "robot", 0.02);
  std::vector<ros::Odometry> reports;
  client.observe_channel<ros::Odometry>(ros::kOdometry, "rt/robot0/odom",
                                        [&](const ros::Odometry& message) { reports.push_back(message); });
  const auto writer = client.relay(ros::kTwist, "rt/robot0/cmd_vel");
  ros::Twist twist, bad;
  twist.linear = {0.5, 0.2, 0};
  twist.angular = {0, 0, 0.3};
  bad.linear = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
  for (int i = 0; i < 200; ++i) {
    writer->write(&bad);
    writer->write(&twist);
    network.run_until(network.now() + 10ms);
  }
  const Body& body = node.world_now().bodies()[0];
  const Vec2 moved_m = rotated(Vec2(body.position_m() - Vec2(1, 1)), -2);
  CHECK(moved_m.norm() > 0.8);
  REQUIRE(reports.size() >= 98);
  const ros::Odometry& last = reports.back();
  CHECK(last.position[0] == Approx(1.02 * moved_m.x()).margin(0.015));
  CHECK(last.position[1] == Approx(1.02 * moved_m.y()).margin(0.015));
  CHECK(2 * std::atan2(last.orientation[2], last.orientation[3]) ==
        Approx(body.heading_rad() - 2).margin(0.01));
  CHECK(last.twist.linear[0] == Approx(1.02 * 0.5).margin(0.02));
  CHECK(last.child_frame_id == "base_link");
}

}  // namespace sidestep::velocity_server_test
