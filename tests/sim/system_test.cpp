// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "common/json/json_text.hpp"
#include "common/protocol/process_names.hpp"
#include "deploy/audit/metrics/report.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"
#include "tests/catch.hpp"

namespace sidestep::system_test {

Scenario shipped(const std::string& name) {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/" + name + ".yaml");
}

/// A system with checks by metrics, audit and firmware monitors.
struct MonitoredSystem {
  Scenario scenario;
  SimSystem system;

  MonitoredSystem(const Scenario& s, std::uint64_t seed) : scenario(s), system(scenario, seed) {}

  void require_safe() {
    const Report report = system.metrics().report();
    REQUIRE(report.contacts == 0);
    REQUIRE(report.firmware_violations == 0);
    for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
    REQUIRE(report.audit->violations == 0);
    REQUIRE(report.audit->compared_pairs > 0);
    REQUIRE(report.audit->verdict() == AuditVerdict::kPassed);
  }
  double speed_mps(RobotId robot) {
    for (const RobotProgress& row : system.metrics().progress()) {
      if (row.robot == robot) return row.speed_mps;
    }
    return -1;
  }
  double max_speed_mps() {
    double max_mps = 0;
    for (const RobotProgress& row : system.metrics().progress()) max_mps = std::max(max_mps, row.speed_mps);
    return max_mps;
  }
  /// Runs until this robot drives at 0.8 m/s.
  void run_until_speed(RobotId robot) {
    for (int i = 0; i < 1000 && speed_mps(robot) < 0.8; ++i) system.run_for(std::chrono::milliseconds(10));
    REQUIRE(speed_mps(robot) >= 0.8);
  }
};

void count_own_stops(SimSystem& system, int& own_stops) {
  system.on_event(LogLevel::kWarning, [&own_stops](const std::string&, const LogEvent& event) {
    own_stops += event.text.find("makes its own stop") != std::string::npos;
  });
}

TEST_CASE("robots arrive with any camera rate and wheel error that a scenario may specify") {
  const auto [rate_hz, scale_error] = GENERATE(table<double, double>({{5, 0.005}, {7, 0.02}, {1000, 0.05}}));
  Scenario scenario = shipped("crossing");
  scenario.vision.rate_hz = rate_hz;
  scenario.odometry.scale_error = scale_error;
  CAPTURE(rate_hz, scale_error);
  MonitoredSystem run(scenario, 1);
  CHECK(run.system.run_until_arrived(run.system.begin() + std::chrono::seconds(60)));
  run.require_safe();
}

TEST_CASE("simulated robots obey any motion limits that a scenario specifies") {
  const auto seed = GENERATE(range(1u, 31u));
  Rng rng(seed);
  Scenario scenario = shipped("crossing");
  const auto log_uniform = [&](double low, double high) { return low * std::pow(high / low, rng.uniform()); };
  scenario.limits.acceleration_mps2 = log_uniform(0.5, 30);
  scenario.limits.deceleration_mps2 = log_uniform(0.5, 30);
  scenario.limits.speed_mps = log_uniform(0.3, 5);
  scenario.margin_m =
      2 * scenario.tracking_bound_m + 4 * scenario.clock_bound_s * scenario.limits.speed_mps + 1e-6;
  CAPTURE(seed, scenario.limits.acceleration_mps2, scenario.limits.deceleration_mps2,
          scenario.limits.speed_mps);
  MonitoredSystem run(scenario, seed);
  int own_stops = 0;
  count_own_stops(run.system, own_stops);
  CHECK(run.system.run_until_arrived(run.system.begin() + std::chrono::seconds(60)));
  run.require_safe();
  CHECK(own_stops == 0);
}

TEST_CASE("a robot arrives with any control cycle and any motor strength that a scenario may specify") {
  const auto seed = GENERATE(range(1u, 61u));
  Rng rng(seed);
  const double rate_hz = 5 * std::pow(100, rng.uniform()),
               acceleration_mps2 = 1.5 * std::pow(13, rng.uniform()),
               speed_mps = 0.2 * std::pow(9, rng.uniform());
  CAPTURE(seed, rate_hz, acceleration_mps2, speed_mps);
  Scenario scenario = parse_scenario(
      fmt::format("{{name: slow, field: {{length_m: 6, width_m: 4}}, control_rate_hz: {:.3f}, "
                  "limits: {{acceleration_mps2: {:.3f}, deceleration_mps2: {:.3f}, speed_mps: {:.3f}}}, "
                  "robots: [{{id: 0, start_m: [-1, 0], goals_m: [[1, 0.3]]}}]}}",
                  rate_hz, acceleration_mps2,
                  std::min(50.0, acceleration_mps2 * std::pow(10, rng.uniform(-0.5, 1))), speed_mps),
      "slow.yaml");
  MonitoredSystem run(scenario, seed);
  int own_stops = 0;
  count_own_stops(run.system, own_stops);
  CHECK(run.system.run_until_arrived(run.system.begin() + std::chrono::seconds(60)));
  CHECK(own_stops == 0);
  const Report report = run.system.metrics().report();
  CHECK(report.firmware_violations == 0);
  CHECK(report.audit->violations == 0);
}

TEST_CASE("in every shipped scenario all robots arrive without contact") {
  const std::string name =
      GENERATE("crossing", "crossing-images", "crossing-noisy", "circle-20", "circle-100", "two-teams-22");
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(name, seed);
  MonitoredSystem run(shipped(name), seed);
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(run.scenario.time_limit_s)));
  run.require_safe();
  const Report report = run.system.metrics().report();
  CHECK(report.arrived == static_cast<int>(run.scenario.robots.size()));
  CHECK(report.max_reference_error_m < run.scenario.margin_m);
}

TEST_CASE("equal seeds give equal reports, and different seeds give different reports") {
  const auto report_of = [](std::uint64_t seed) {
    MonitoredSystem run(shipped("crossing-noisy"), seed);
    (void)run.system.run_until_arrived(run.system.begin() + from_seconds(20));
    auto json = parse_json(to_json(run.system.metrics().report()));
    json.erase("wall_clock");
    return json_text(json);
  };
  const auto first = report_of(5);
  CHECK(first == report_of(5));
  CHECK(first != report_of(6));
}

TEST_CASE(
    "loss, delay, duplicates and reordering may slow robots down but cause no contact, over fifty seeds") {
  Scenario scenario = shipped("crossing");
  scenario.network.loss = 0.3;
  scenario.network.duplicate = 0.1;
  scenario.network.delay_min = Duration{0};
  scenario.network.delay_max = std::chrono::milliseconds(150);
  int arrived = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    MonitoredSystem run(scenario, seed);
    (void)run.system.run_until_arrived(run.system.begin() + from_seconds(60));
    run.require_safe();
    arrived += run.system.metrics().arrived();
  }
  // Robots that never move would also be safe, so some must arrive. Clocks are known only within tens of
  // milliseconds here, so robots are slow, and stay far from silent robots.
  CHECK(arrived > 120);
}

TEST_CASE(
    "when an agent dies, its robot stops without contact, the others arrive, and the report lists the "
    "agent") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  MonitoredSystem run(shipped("crossing"), seed);
  const RobotId victim = 2;
  run.run_until_speed(victim);
  const double speed = run.speed_mps(victim);
  run.system.kill(agent_process(victim));
  // The robot brakes at the end of its last version.
  const MotionLimits& limits = run.scenario.limits;
  run.system.run_for(from_seconds((speed + 0.1) / limits.deceleration_mps2) + 4 * run.scenario.cycle);
  CHECK(run.speed_mps(victim) < 0.02);
  (void)run.system.run_until_arrived(run.system.begin() + from_seconds(20));
  run.require_safe();
  const Report report = run.system.metrics().report();
  CHECK(report.arrived == 7);
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].process == "agent 2");
}

TEST_CASE("a restarted agent drives its robot the rest of the way to its goal") {
  MonitoredSystem run(shipped("crossing"), 4);
  run.run_until_speed(5);
  run.system.kill(agent_process(5));
  run.system.run_for(from_seconds(1));
  run.system.restart(agent_process(5));
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}

TEST_CASE(
    "without a coordinator all robots stop within v/D plus a cycle, and with a new coordinator they reach "
    "their goals") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  MonitoredSystem run(shipped("crossing"), seed);
  run.run_until_speed(0);
  const double speed = run.max_speed_mps();
  run.system.kill("coordinator");
  // A version granted just before the kill is still executed: it begins within a cycle and accelerates for a
  // cycle.
  const MotionLimits& limits = run.scenario.limits;
  const double cycle_s = to_seconds(run.scenario.cycle);
  const double max_speed = speed + 2 * cycle_s * limits.acceleration_mps2;
  // The latest ground truth received is up to a cycle old, and bodies follow their reference with a lag.
  run.system.run_for(from_seconds(max_speed / limits.deceleration_mps2 + 2 * cycle_s) +
                     2 * run.scenario.cycle);
  CHECK(run.max_speed_mps() < 0.03);
  run.system.run_for(from_seconds(1));
  CHECK(run.max_speed_mps() < 0.02);
  run.system.restart("coordinator");
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}

TEST_CASE("robots stop when vision dies, and continue after its restart") {
  MonitoredSystem run(shipped("crossing"), 3);
  run.run_until_speed(0);
  run.system.kill("vision");
  run.system.run_for(from_seconds(1.2));
  CHECK(run.max_speed_mps() < 0.02);
  run.system.restart("vision");
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}

TEST_CASE("the report lists each epoch with its reason, and processes log the same reason") {
  Scenario scenario = shipped("crossing");
  scenario.coordinators = 2;
  MonitoredSystem run(scenario, 1);
  std::vector<std::string> events;
  run.system.on_event(LogLevel::kInfo, [&](const std::string& process, const LogEvent& event) {
    events.push_back(process + ": " + event.text);
  });
  const auto reported = [&](const std::string& text) {
    return std::ranges::any_of(
        events, [&](const std::string& event) { return event.find(text) != std::string::npos; });
  };
  run.run_until_speed(0);
  run.system.kill("coordinator");
  CHECK(run.system.run_until_arrived(run.system.begin() + std::chrono::seconds(60)));
  run.require_safe();
  const Report report = run.system.metrics().report();
  REQUIRE(report.epochs.size() == 2);
  CHECK(report.epochs[0].coordinator == "coordinator");
  CHECK_THAT(report.epochs[0].reason, ContainsSubstring("no coordinator was active for 1"));
  CHECK(report.epochs[0].at_s.value_or(0) < 0);
  CHECK(report.epochs[1].coordinator == "coordinator 1");
  CHECK(report.epochs[1].epoch > report.epochs[0].epoch);
  CHECK_THAT(report.epochs[1].reason, ContainsSubstring("no heartbeat of coordinator 0 for 1"));
  CHECK(report.epochs[1].at_s.value_or(0) > 0.3);
  CHECK_THAT(summary(report), ContainsSubstring("coordinator 1 began epoch"));
  const auto json = parse_json(to_json(report));
  CHECK(json["epochs"][1]["reason"] == report.epochs[1].reason);
  const std::string second = std::to_string(report.epochs[1].epoch);
  CHECK(reported("coordinator 1: begins epoch " + second + ": no heartbeat of coordinator 0 for 1"));
  CHECK(reported("agent 0: adopted epoch " + second + " of coordinator 1"));
  CHECK(reported("agent 0: registered in epoch " + second));
  CHECK(reported("agent 0: arrived at goal 0, the last goal"));
}

}  // namespace sidestep::system_test
