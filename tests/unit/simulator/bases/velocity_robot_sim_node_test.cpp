// SPDX-License-Identifier: Apache-2.0
#include "simulator/bases/velocity_robot_sim_node.hpp"

#include <cmath>
#include <set>

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
  VelocityRobotSimNode node(bus, one_robot(), {}, 7, 1);
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
  VelocityRobotSimNode node(bus, one_robot(), {.pace = {.speeds = {0.5}}}, 7, 1);
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

TEST_CASE("frames tell their simulated capture time, which advances in steps at the simulation's speed") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network);
  Scenario scenario = one_robot();
  scenario.vision.delay = 0ms;
  const Duration step = from_seconds(1.0 / 60);
  VelocityRobotSimNode node(bus, scenario, {.pace = {.speeds = {0.98}, .step = step}}, 7, 1);
  std::vector<std::pair<Time, Time>> frames;  // real time of arrival, simulated time of capture
  node.set_detection_listener([&](const msg::DetectionFrame& frame, Time simulated) {
    frames.emplace_back(network.now(), simulated);
    CHECK(std::abs(to_seconds(time_from_ns(frame.captured_at_ns()) - kBegin) * 0.98 -
                   to_seconds(simulated - kBegin)) < 1e-6);
  });
  network.run_until(kBegin + 10s);
  // 60 frames per simulated second, each captured at a step.
  CHECK(frames.size() == Approx(588).margin(1));
  for (std::size_t i = 1; i < frames.size(); ++i) {
    CHECK(std::abs(to_seconds(frames[i].second - frames[i - 1].second - step)) < 0.0011);
    const double late_s = to_seconds(frames[i].first - kBegin) - to_seconds(frames[i].second - kBegin) / 0.98;
    CHECK(late_s > -1e-6);
    CHECK(late_s < 0.021);
  }
}

TEST_CASE("a simulation that was paused for long continues where it was, at its speed") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network);
  VelocityRobotSimNode node(bus, one_robot(), {.pace = {.speeds = {0.5}}}, 7, 1);
  network.run_until(kBegin + 2s);
  const Time before = node.simulated_now();
  bus.pause(kBegin + 7s, 0);
  network.run_until(kBegin + 9s);
  CHECK(to_seconds(node.simulated_now() - before) == Approx(1).margin(0.01));
}

TEST_CASE("the time at which a robot was placed stays the same however often the speed then changes") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network), observer(network);
  std::set<std::int64_t> ends_ns;
  observer.subscribe<msg::GroundTruth>(topics::kTruth, [&](const auto& truth) {
    for (const auto& robot : truth.robots()) {
      if (robot.disturbance_end_ns() >= 0) ends_ns.insert(robot.disturbance_end_ns());
    }
  });
  const PaceSettings pace{.speeds = {0.5, 1}, .speed_duration = 100ms};
  VelocityRobotSimNode node(bus, one_robot(), {.pace = pace}, 7, 1);
  network.run_until(kBegin + 250ms);
  node.world_now().place(0, {1, 1}, 0);
  network.run_until(kBegin + 5s);
  REQUIRE(ends_ns.size() == 1);
  CHECK(std::abs(to_seconds(time_from_ns(*ends_ns.begin()) - kBegin) - 0.25) < 0.003);
}

TEST_CASE("robots can start elsewhere than the scenario says") {
  SimNetwork network(1, kBegin, {});
  SimBus bus(network);
  VelocityRobotSimNode node(bus, one_robot(), {.team_size = 11, .starts = StartPlaces::kLine}, 7, 1);
  CHECK(node.world_now().bodies().size() == 22);
  CHECK(node.world_now().bodies()[0].position_m().x() == Approx(-0.15));
}

}  // namespace sidestep::velocity_robot_sim_node_test
