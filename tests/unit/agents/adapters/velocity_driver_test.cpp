// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/velocity/velocity_driver.hpp"

#include <cmath>
#include <limits>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::velocity_driver_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// A driver for robots 3 and 4, and the other end of robot 3's topics.
struct Scene {
  Scene() {
    base_bus.observe_channel<ros::Twist>(ros::kTwist, "rt/robot3/cmd_vel",
                                         [this](const ros::Twist& twist) { twists.push_back(twist); });
    driver.on_odometry([this](const OdometryReport& report) { reports.push_back(report); });
  }
  void report(const ros::Odometry& odometry) {
    writer->write(&odometry);
    network.run_until(network.now() + 5ms);
  }
  ros::Odometry odometry() const {
    ros::Odometry message;
    const std::int64_t ns = to_ns(network.now());
    message.sec = static_cast<std::int32_t>(ns / 1'000'000'000);
    message.nanosec = static_cast<std::uint32_t>(ns % 1'000'000'000);
    message.position = {1, 2, 0};
    message.orientation = {0, 0, std::sin(0.6), std::cos(0.6)};
    return message;
  }
  SimNetwork network{1, kBegin, {}};
  SimBus bus{network}, base_bus{network};
  VelocityDriver driver{bus, {3, 4}, "robot"};
  std::unique_ptr<RawWriter> writer = base_bus.relay(ros::kOdometry, "rt/robot3/odom");
  std::vector<ros::Twist> twists;
  std::vector<OdometryReport> reports;
};

TEST_CASE("velocities are sent as twists, and odometry is received with its time of measurement") {
  Scene scene;
  const std::vector<BaseCommand> commands{{3, {{0.5, -0.25}, 1.5}}, {4, {}}};
  scene.driver.send(commands);
  scene.network.run_until(kBegin + 5ms);
  REQUIRE(scene.twists.size() == 1);
  CHECK(scene.twists[0].linear == std::array<double, 3>{0.5, -0.25, 0});
  CHECK(scene.twists[0].angular == std::array<double, 3>{0, 0, 1.5});
  const Time measured = scene.network.now();
  scene.report(scene.odometry());
  REQUIRE(scene.reports.size() == 1);
  CHECK(scene.reports[0].robot == 3);
  CHECK(scene.reports[0].measured_at == measured);
  CHECK(scene.reports[0].position_m == Vec2(1, 2));
  CHECK(scene.reports[0].heading_rad == Approx(1.2));
  // The base's clock is wrong by less than a second. The driver does not decide whether to trust it.
  ros::Odometry wrong_timestamp_odometry = scene.odometry();
  wrong_timestamp_odometry.nanosec += 100'000'000;
  scene.report(wrong_timestamp_odometry);
  REQUIRE(scene.reports.size() == 2);
  CHECK(scene.reports[1].measured_at > scene.network.now());
  // The base's clock has a different epoch, for example that of a simulation.
  ros::Odometry old = scene.odometry();
  old.sec = 17;
  const Time sent = scene.network.now();
  scene.report(old);
  REQUIRE(scene.reports.size() == 3);
  CHECK(scene.reports[2].measured_at - sent < 1ms);
}

TEST_CASE("odometry with invalid numbers is dropped and counted") {
  Scene scene;
  const auto bad =
      GENERATE(std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e9);
  ros::Odometry place = scene.odometry(), turn = scene.odometry(), none = scene.odometry();
  place.position[1] = bad;
  turn.orientation[2] = bad;
  none.orientation = {0, 0, 0, 0};  // as in a message whose orientation was never set
  scene.report(place);
  scene.report(turn);
  scene.report(none);
  CHECK(scene.reports.empty());
  DropCounters drops;
  scene.driver.count_drops(drops);
  CHECK(drops.total(DropReason::kMalformedOdometry) == 3);
}

}  // namespace sidestep::velocity_driver_test
