// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/config/scenario_loader.hpp"
#include "deploy/monitor/metrics/report.hpp"
#include "deploy/simulate/system/sim_system.hpp"

using namespace sidestep;

namespace {

Scenario shipped(const std::string& name) {
  return load_scenario(std::string(SIDESTEP_SOURCE_DIR) + "/deploy/scenarios/" + name + ".yaml");
}

/// A system under the eyes of everything that judges.
struct Watched {
  Scenario scenario;
  SimSystem system;

  Watched(const Scenario& s, std::uint64_t seed) : scenario(s), system(scenario, seed) {}

  void require_safe() {
    const Report report = system.judge().report();
    REQUIRE(report.contacts == 0);
    REQUIRE(report.firmware_violations == 0);
    for (const Violation& violation : report.audit->first) UNSCOPED_INFO(to_line(violation));
    REQUIRE(report.audit->violations == 0);
    REQUIRE(report.audit->pairs > 0);
  }
  double speed_mps(RobotId robot) {
    for (const RobotProgress& row : system.judge().progress()) {
      if (row.robot == robot) return row.speed_mps;
    }
    return -1;
  }
  double fastest_mps() {
    double fastest = 0;
    for (const RobotProgress& row : system.judge().progress()) fastest = std::max(fastest, row.speed_mps);
    return fastest;
  }
  /// Runs until this robot drives at speed.
  void run_until_fast(RobotId robot) {
    for (int i = 0; i < 1000 && speed_mps(robot) < 0.8; ++i) system.run_for(std::chrono::milliseconds(10));
    REQUIRE(speed_mps(robot) >= 0.8);
  }
};

}  // namespace

TEST_CASE("in every shipped scenario everybody arrives and nobody touches") {
  const std::string name =
      GENERATE("crossing", "crossing-images", "crossing-noisy", "circle-20", "circle-100", "two-teams-22");
  const std::uint64_t seed = GENERATE(1u, 2u);
  CAPTURE(name, seed);
  Watched run(shipped(name), seed);
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(run.scenario.time_limit_s)));
  run.require_safe();
  const Report report = run.system.judge().report();
  CHECK(report.arrived == static_cast<int>(run.scenario.robots.size()));
  CHECK(report.max_reference_error_m < run.scenario.margin_m);
}

TEST_CASE("the same seed gives the same report, and another seed another one") {
  const auto report_of = [](std::uint64_t seed) {
    Watched run(shipped("crossing-noisy"), seed);
    (void)run.system.run_until_arrived(run.system.begin() + from_seconds(20));
    auto json = nlohmann::json::parse(to_json(run.system.judge().report()));
    json.erase("wall_clock");
    return json.dump();
  };
  const auto first = report_of(5);
  CHECK(first == report_of(5));
  CHECK(first != report_of(6));
}

TEST_CASE(
    "loss, delay, duplicates and reordering may slow robots down but nobody touches, over fifty seeds") {
  Scenario scenario = shipped("crossing");
  scenario.network.loss = 0.3;
  scenario.network.duplicate = 0.1;
  scenario.network.delay_min = Duration{0};
  scenario.network.delay_max = std::chrono::milliseconds(150);
  int arrived = 0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    Watched run(scenario, seed);
    (void)run.system.run_until_arrived(run.system.begin() + from_seconds(30));
    run.require_safe();
    arrived += run.system.judge().arrived();
  }
  // A system that did nothing would be safe too.
  CHECK(arrived > 200);
}

TEST_CASE(
    "when an agent dies its robot stops by itself, nobody touches it, the others arrive, the report names "
    "it") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Watched run(shipped("crossing"), seed);
  const RobotId victim = 2;
  run.run_until_fast(victim);
  const double speed = run.speed_mps(victim);
  run.system.kill(agent_process(victim));
  // It brakes from the end of the version that it holds on.
  const MotionLimits& limits = run.scenario.limits;
  run.system.run_for(from_seconds((speed + 0.1) / limits.deceleration_mps2) + 4 * run.scenario.cycle);
  CHECK(run.speed_mps(victim) < 0.02);
  (void)run.system.run_until_arrived(run.system.begin() + from_seconds(20));
  run.require_safe();
  const Report report = run.system.judge().report();
  CHECK(report.arrived == 7);
  REQUIRE(report.deaths.size() == 1);
  CHECK(report.deaths[0].process == "agent 2");
}

TEST_CASE("an agent that comes back drives its robot on to its goal") {
  Watched run(shipped("crossing"), 4);
  run.run_until_fast(5);
  run.system.kill(agent_process(5));
  run.system.run_for(from_seconds(1));
  run.system.restart(agent_process(5));
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}

TEST_CASE(
    "without a coordinator all robots stop within v/D and a cycle, with a new one they go on to their "
    "goals") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Watched run(shipped("crossing"), seed);
  run.run_until_fast(0);
  const double fastest = run.fastest_mps();
  run.system.kill("coordinator");
  // A version granted a moment ago is still taken: it begins within a cycle and accelerates for another.
  const MotionLimits& limits = run.scenario.limits;
  const double cycle_s = to_seconds(run.scenario.cycle);
  const double faster = fastest + 2 * cycle_s * limits.acceleration_mps2;
  // The last ground truth to reach the judge is a cycle old, and bodies follow their reference with a lag.
  run.system.run_for(from_seconds(faster / limits.deceleration_mps2 + 2 * cycle_s) + 2 * run.scenario.cycle);
  CHECK(run.fastest_mps() < 0.03);
  run.system.run_for(from_seconds(1));
  CHECK(run.fastest_mps() < 0.02);
  run.system.restart("coordinator");
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}

TEST_CASE("robots that vision does not see stop, and go on when it does again") {
  Watched run(shipped("crossing"), 3);
  run.run_until_fast(0);
  run.system.kill("vision");
  run.system.run_for(from_seconds(1.2));
  CHECK(run.fastest_mps() < 0.02);
  run.system.restart("vision");
  CHECK(run.system.run_until_arrived(run.system.begin() + from_seconds(25)));
  run.require_safe();
}
