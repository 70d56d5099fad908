// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/skeleton/skeleton_camera.hpp"

#include <numbers>
#include <vector>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::skeleton_camera_test {

using namespace std::chrono_literals;

TEST_CASE("the template's camera sees its bases where they have driven to, seen from their starts") {
  SimNetwork network(1, time_from_ns(1'000'000'000'000), {});
  SimBus bus(network), observer(network);
  Scenario scenario;
  scenario.vision.columns = 2;
  scenario.vision.rows = 1;
  RobotSpec robot;
  robot.id = 4;
  robot.start_m = {1, 2};
  robot.start_heading_rad = std::numbers::pi / 2;
  scenario.robots.push_back(robot);
  std::vector<msg::DetectionFrame> frames;
  observer.subscribe<msg::DetectionFrame>(topics::kDetections,
                                          [&](const msg::DetectionFrame& frame) { frames.push_back(frame); });
  SkeletonDriver driver({4}, [&] { return bus.now(); });
  const SkeletonCamera camera(bus, scenario, {4}, driver, 77);

  network.run_until(network.now() + 100ms);
  CHECK(frames.empty());  // nothing is new before the first command
  const std::vector<BaseCommand> ahead{{4, {{0.5, 0}, 0}}};
  for (int i = 0; i < 101; ++i) {
    driver.send(ahead);
    network.run_until(network.now() + 10ms);
  }
  REQUIRE(frames.size() > 100);  // of two cameras, sixty times a second each
  int seen = 0;
  msg::RobotDetection robot_seen;
  Time last{};
  for (const msg::DetectionFrame& frame : frames) {
    CHECK(frame.header().incarnation() == 77);
    CHECK(frame.obstacles_complete_within_m() == 1e9);
    CHECK(frame.camera() < 2);
    if (frame.camera() > 0) {
      CHECK(frame.robots().empty());
      continue;
    }
    REQUIRE(frame.robots().size() == 1);
    CHECK(time_from_ns(frame.captured_at_ns()) > last);
    last = time_from_ns(frame.captured_at_ns());
    robot_seen = frame.robots()[0];
    ++seen;
  }
  CHECK(seen > 50);
  CHECK(robot_seen.robot() == 4);
  CHECK(robot_seen.x_m() == Approx(1));
  CHECK(robot_seen.y_m() == Approx(2.5).margin(0.02));
  CHECK(robot_seen.heading_rad() == Approx(std::numbers::pi / 2));
}

}  // namespace sidestep::skeleton_camera_test
