// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/conformance/conformance.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "common/messaging/robot_codec.hpp"
#include "common/protocol/report_period.hpp"
#include "simulator/world/simulator_node.hpp"
#include "tests/catch.hpp"
#include "tests/sim/driven_floor.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep::conformance_test {

using namespace std::chrono_literals;

constexpr Time kBegin = time_from_ns(1'700'000'000'000'000'000);
constexpr RobotId kRobot = 3;

/// A scenario with one robot on a division-B field.
Scenario lone_robot() {
  Scenario scenario;
  scenario.name = "lone robot";
  RobotSpec robot;
  robot.id = kRobot;
  robot.start_m = {-1, 0.5};
  scenario.robots.push_back(robot);
  return scenario;
}

/// The scenario of lone_robot() with vision as in the league, and a budget for third-party bases.
Scenario lone_league_robot() {
  Scenario scenario = lone_robot();
  scenario.vision.position_noise_m = 0.0015;
  scenario.vision.delay = 35ms;
  scenario.vision.miss_probability = 0.02;
  scenario.tracking_bound_m = 0.034;
  scenario.margin_m = 0.072;
  return scenario;
}

ConformanceReport examine(SimNetwork& network, const Scenario& scenario) {
  SimBus vision_bus(network), bus(network);
  VisionNode vision(vision_bus, scenario, 1);
  Conformance conformance(bus, scenario, kRobot, static_cast<Incarnation>(to_ns(network.now())));
  const Time limit = network.now() + 300s;
  while (!conformance.is_finished() && network.now() < limit) network.run_until(network.now() + 100ms);
  REQUIRE(conformance.is_finished());
  return conformance.report();
}

ConformanceReport examine_firmware(const Scenario& scenario, std::uint64_t seed) {
  SimNetwork network(seed, kBegin, scenario.network);
  SimBus bus(network);
  SimulatorNode simulator(bus, scenario, 1, seed);
  return examine(network, scenario);
}

ConformanceReport examine_driven(const Scenario& scenario, const BaseSettings& bases, Duration latency,
                                 std::uint64_t seed) {
  SimNetwork network(seed, kBegin, scenario.network);
  DrivenFloor floor(network, scenario, bases, latency, seed);
  return examine(network, scenario);
}

std::vector<std::string> failed(const ConformanceReport& report) {
  std::vector<std::string> rules;
  for (const ConformanceRow& row : report.rows) {
    if (row.conformity == Conformity::kFailed) rules.push_back(row.rule);
  }
  return rules;
}

TEST_CASE("a healthy robot with Sidestep's firmware conforms") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const ConformanceReport report = examine_firmware(lone_robot(), seed);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(report.is_conformant());
}

TEST_CASE("a healthy robot conforms at any rate and phase of the cameras") {
  const auto [rate_hz, seed] =
      GENERATE(table<double, std::uint64_t>({{5, 1}, {9, 1}, {10, 1}, {10, 2}, {10, 3}, {25, 1}}));
  Scenario scenario = lone_robot();
  scenario.vision.rate_hz = rate_hz;
  scenario.vision.position_noise_m = 0;
  scenario.limits.speed_mps = 1;
  const ConformanceReport report = examine_firmware(scenario, seed);
  INFO("rate " << rate_hz << " seed " << seed << "\n" << to_text(report));
  CHECK(report.is_conformant());
}

// The latency that an earlier conformance test measured; see the test of the measured latency.
constexpr Duration kMeasuredLatency = 118ms;

TEST_CASE("a third-party base conforms when it is driven in single precision") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const ConformanceReport report = examine_driven(lone_league_robot(), {}, kMeasuredLatency, seed);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(report.is_conformant());
  CHECK(report.figures.is_within_limits);
}

TEST_CASE("a robot conforms if it assumes the latency that was measured") {
  const auto [latency, counted] =
      GENERATE(table<Duration, Duration>({{60ms, 100ms}, {100ms, 60ms}, {100ms, 100ms}, {140ms, 100ms}}));
  BaseSettings bases;
  bases.latency = latency;
  const ConformanceReport report = examine_driven(lone_league_robot(), bases, counted, 4);
  INFO(to_text(report));
  const auto row = std::ranges::find(report.rows, "latency", &ConformanceRow::rule);
  REQUIRE(row != report.rows.end());
  // The motors need about 18 ms more to reach a velocity.
  int measured_ms = 0;
  REQUIRE(std::sscanf(row->figures.c_str(), "the motors obey after %d ms", &measured_ms) == 1);
  CHECK(std::abs(measured_ms - static_cast<int>(to_seconds(latency) * 1e3) - 18) <= 5);
}

TEST_CASE("a robot that brakes with 60 % of its stated deceleration fails the braking check") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  BaseSettings bases;
  bases.braking_mps2 = 3;
  const ConformanceReport report = examine_driven(lone_league_robot(), bases, kMeasuredLatency, seed);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(failed(report) == std::vector<std::string>{"braking"});
  CHECK_FALSE(report.figures.is_within_limits);
}

TEST_CASE("a robot is not blamed for how it moves while reports are missing, and is examined again") {
  const bool is_paused_always = GENERATE(true, false);
  const Scenario scenario = lone_league_robot();
  SimNetwork network(1, kBegin, scenario.network);
  BaseSettings bases;
  bases.braking_mps2 = 3;
  DrivenFloor floor(network, scenario, bases, kMeasuredLatency, 1);
  SimBus vision_bus(network), bus(network);
  VisionNode vision(vision_bus, scenario, 1);
  Conformance conformance(bus, scenario, kRobot, static_cast<Incarnation>(to_ns(network.now())));
  const Time limit = network.now() + 300s;
  Time next_pause{};
  while (!conformance.is_finished() && network.now() < limit) {
    const bool is_due = conformance.activity() == "braking" || is_paused_always;
    if (is_due && conformance.activity().starts_with("braking") && network.now() >= next_pause) {
      bus.pause(network.now() + 60ms, 1000);
      next_pause = network.now() + 1s;
    }
    network.run_until(network.now() + 20ms);
  }
  INFO(to_text(conformance.report()));
  REQUIRE(conformance.is_finished());
  const auto& rows = conformance.report().rows;
  REQUIRE(std::ranges::count(rows, "braking", &ConformanceRow::rule) == 1);
  const ConformanceRow& row = *std::ranges::find(rows, "braking", &ConformanceRow::rule);
  CHECK(row.conformity == (is_paused_always ? Conformity::kNotJudged : Conformity::kFailed));
  if (is_paused_always) CHECK_THAT(row.figures, ContainsSubstring("a computer or the network is too busy"));
}

TEST_CASE("a negative latency is not judged, and no figure is printed") {
  const ConformanceRow row = latency_row({40ms, -51ms, 1ms, 2}, 1);
  CHECK(row.conformity == Conformity::kNotJudged);
  CHECK(row.figures.find_first_of("0123456789") == std::string::npos);
  CHECK(latency_row({40ms, 0ms, 1ms, 2}, 0.01).conformity == Conformity::kPassed);
  CHECK(latency_row({40ms, 50ms, 1ms, 2}, 0.01).conformity == Conformity::kFailed);
}

TEST_CASE("a robot that assumes 100 ms of latency but has 150 ms fails the latency check") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  BaseSettings bases;
  bases.latency = 150ms - 18ms;
  const ConformanceReport report = examine_driven(lone_league_robot(), bases, 100ms, seed);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(failed(report) == std::vector<std::string>{"latency"});
}

TEST_CASE("a robot whose clock is 5 ms off fails the clock check") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const Duration offset = GENERATE(5ms, -5ms);
  Scenario scenario = lone_robot();
  scenario.robots.front().clock_offset = offset;
  const ConformanceReport report = examine_firmware(scenario, seed);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(failed(report) == std::vector<std::string>{"clock"});
}

TEST_CASE("a robot that still obeys fenced agents fails the fence check") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const Scenario scenario = lone_league_robot();
  SimNetwork network(seed, kBegin, scenario.network);
  // Makes the robot treat every command as one from the latest agent and epoch.
  const auto ignore_fences = [latest =
                                  std::pair<std::uint64_t, std::uint64_t>()](msg::Command& command) mutable {
    const Time now = kBegin + 300s;
    if (!is_plausible(command.header().incarnation(), now) || !is_plausible(command.epoch(), now)) return;
    latest.first = std::max<std::uint64_t>(latest.first, command.header().incarnation());
    latest.second = std::max<std::uint64_t>(latest.second, command.epoch());
    command.header().incarnation(latest.first);
    command.version().incarnation(latest.first);
    command.epoch(latest.second);
  };
  DrivenFloor floor(network, scenario, {}, kMeasuredLatency, seed, ignore_fences);
  const ConformanceReport report = examine(network, scenario);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(failed(report) == std::vector<std::string>{"fences"});
}

TEST_CASE("a robot that acknowledges a new agent too late fails the check of pending versions") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  const Scenario scenario = lone_league_robot();
  SimNetwork network(seed, kBegin, scenario.network);
  std::uint64_t obeyed = 0;
  std::optional<Time> heard_at;
  const auto obey_late = [&](msg::Command& command) {
    const std::uint64_t agent = command.header().incarnation();
    if (agent <= obeyed || !is_plausible(agent, network.now())) return;
    if (!heard_at) heard_at = network.now();
    if (obeyed != 0 && network.now() - *heard_at < 300ms) return command.header().incarnation(obeyed);
    obeyed = agent;
    heard_at.reset();
  };
  DrivenFloor floor(network, scenario, {}, kMeasuredLatency, seed, obey_late);
  const ConformanceReport report = examine(network, scenario);
  INFO("seed " << seed << "\n" << to_text(report));
  CHECK(failed(report) == std::vector<std::string>{"pending versions"});
}

/// Sends reports that obey every agent, one every `gap`, and does nothing else.
class ReportingRobot {
 public:
  ReportingRobot(SimNetwork& network, Duration gap) : bus_(network), gap_(gap) {
    report_.robot = report_.executing.robot = kRobot;
    report_.executing.trajectory = Trajectory::resting(bus_.now(), {0, 0});
    bus_.subscribe<msg::Command>(topics::kCommand, kRobot, [this](const msg::Command& command) {
      report_.obeyed_incarnation = command.header().incarnation();
      report_.obeyed_epoch = command.epoch();
    });
    report();
  }

 private:
  void report() {
    report_.valid_at = bus_.now();
    msg::Feedback message = encode(report_);
    writer_.publish(message, bus_.now());
    bus_.at(bus_.now() + gap_, [this] { report(); });
  }

  SimBus bus_;
  Duration gap_;
  RobotReport report_;
  Writer<msg::Feedback> writer_ = bus_.advertise(topics::kFeedback, kRobot);
};

TEST_CASE("a robot passes the check of reports if it reports as often as it must, at any control rate") {
  Scenario scenario = lone_robot();
  const int rate_hz = GENERATE(5, 30, 60, 100, 500);
  scenario.cycle = from_seconds(1.0 / rate_hz);
  const Duration lateness = GENERATE(0ms, 17ms);
  SimNetwork network(1, kBegin, scenario.network);
  ReportingRobot robot(network, max_report_gap(scenario.cycle) + lateness);
  SimBus bus(network);
  Conformance conformance(bus, scenario, kRobot, static_cast<Incarnation>(to_ns(network.now())));
  network.run_until(network.now() + 4s);
  REQUIRE_FALSE(conformance.report().rows.empty());
  const ConformanceRow& row = conformance.report().rows.front();
  CAPTURE(rate_hz, lateness, to_line(row));
  CHECK(row.rule == "reports");
  CHECK(row.conformity == (lateness == 0ms ? Conformity::kPassed : Conformity::kFailed));
}

TEST_CASE("a robot is not blamed for reports that it makes in time and that arrive late") {
  const Scenario scenario = lone_robot();
  SimNetwork network(1, kBegin, scenario.network);
  ReportingRobot robot(network, max_report_gap(scenario.cycle));
  SimBus bus(network);
  Conformance conformance(bus, scenario, kRobot, static_cast<Incarnation>(to_ns(network.now())));
  const std::size_t max_queued = GENERATE(1u, 1000u);
  const int pauses = GENERATE(2, 20);
  for (int second = 0; second < 20; ++second) {
    network.run_until(network.now() + 1s);
    if (second < pauses) bus.pause(network.now() + 100ms, max_queued);
  }
  REQUIRE_FALSE(conformance.report().rows.empty());
  const ConformanceRow& row = conformance.report().rows.front();
  CAPTURE(max_queued, pauses, to_line(row));
  CHECK(row.rule == "reports");
  CHECK(row.conformity == (pauses == 20 ? Conformity::kNotJudged : Conformity::kPassed));
  if (pauses == 20) CHECK_THAT(row.figures, ContainsSubstring("the network or this computer is too busy"));
}

TEST_CASE("a robot that sends no reports fails the check of reports, and no further checks are made") {
  const Scenario scenario = lone_robot();
  SimNetwork network(1, kBegin, scenario.network);
  const ConformanceReport report = examine(network, scenario);
  CHECK(failed(report) == std::vector<std::string>{"reports"});
  CHECK(report.rows.size() == 1);
}

}  // namespace sidestep::conformance_test
