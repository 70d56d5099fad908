// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/velocity_robot_sim_node.hpp"

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::velocity_robot_sim_node_test {
namespace {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'000'000'000'000);

Scenario one_robot() {
  Scenario scenario;
  scenario.robots.emplace_back();
  scenario.vision.columns = 1;
  scenario.vision.position_noise_m = 0;
  scenario.vision.delay = 35ms;
  return scenario;
}

}  // namespace

TEST_CASE("cameras see the bases after their delay, and ground truth shows the actual state") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network), observer(network);
  std::vector<std::pair<Time, msg::DetectionFrame>> frames;
  std::vector<msg::GroundTruth> truths;
  observer.subscribe<msg::DetectionFrame>(
      topics::kDetections, [&](const auto& frame) { frames.emplace_back(network.now(), frame); });
  observer.subscribe<msg::GroundTruth>(topics::kTruth, [&](const auto& truth) { truths.push_back(truth); });
  VelocityRobotSimNode node(bus, one_robot(), 0, {}, 1, 7, 1);
  for (int i = 0; i < 100; ++i) {
    node.world_now().command(0, {{1, 0}, 0}, node.simulated_now());
    network.run_until(network.now() + 10ms);
  }
  CHECK(frames.size() >= 55);
  CHECK(truths.size() >= 58);
  for (const auto& [at, frame] : frames) {
    const Duration delay = at - time_from_ns(frame.captured_at_ns());
    CHECK(delay >= 35ms);
    CHECK(delay < 40ms);
    CHECK(frame.header().incarnation() == 7);
  }
  CHECK(truths.back().robots()[0].x_m() > 0.5);
}

TEST_CASE("robots in a slow simulation move slowly, but frames are timestamped by the clock") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network), observer(network);
  std::vector<Duration> delays;
  observer.subscribe<msg::DetectionFrame>(topics::kDetections, [&](const auto& frame) {
    delays.push_back(network.now() - time_from_ns(frame.captured_at_ns()));
  });
  VelocityRobotSimNode node(bus, one_robot(), 0, {}, 0.5, 7, 1);
  for (int i = 0; i < 200; ++i) {
    node.world_now().command(0, {{1, 0}, 0}, node.simulated_now());
    network.run_until(network.now() + 10ms);
  }
  // The base drives for a second of simulated time, minus its latency and the time to accelerate.
  CHECK(node.world_now().bodies()[0].position_m().x() == Approx(0.77).margin(0.06));
  CHECK(delays.size() == Approx(58).margin(4));
  for (const Duration delay : delays) CHECK(to_seconds(delay) == Approx(0.073).margin(0.006));
  node.set_speed(1);
  network.run_until(network.now() + 1s);
  CHECK(node.world_now().time() - kBegin == 2s);
}

}  // namespace sidestep::velocity_robot_sim_node_test
