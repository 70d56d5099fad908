// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>

#include "agents/agent/agent_node.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/messaging/sim_bus.hpp"
#include "coordinator/coordinator_node.hpp"
#include "tests/sim/ideal_robots.hpp"
#include "tests/sim/ledger_watch.hpp"

using namespace sidestep;

namespace {

/// Agents and a coordinator around ideal robots: what is promised here is promised exactly, to the last
/// micrometre.
struct Ideal {
  Scenario scenario;
  SimNetwork network;
  SimBus robots_bus{network}, coordinator_bus{network};
  IdealRobots robots;
  LedgerWatch watch;
  std::unique_ptr<CoordinatorNode> coordinator;
  std::vector<std::unique_ptr<SimBus>> buses;
  std::vector<std::unique_ptr<AgentNode>> agents;

  Ideal(const Scenario& s, std::uint64_t seed)
      : scenario(s),
        network(seed, time_from_ns(1'000'000'000), s.network),
        robots(robots_bus, scenario),
        watch(robots_bus, scenario),
        coordinator(std::make_unique<CoordinatorNode>(coordinator_bus, scenario, 1000)) {
    for (const RobotSpec& robot : scenario.robots) {
      buses.push_back(std::make_unique<SimBus>(network));
      agents.push_back(std::make_unique<AgentNode>(*buses.back(), scenario, robot.id, 2000 + seed));
    }
  }
  /// The smallest clearance of any two robots in a run of so many seconds.
  double run(double seconds) {
    double smallest = 1e9;
    const Time end = network.now() + from_seconds(seconds);
    while (network.now() < end) {
      network.run_until(network.now() + Duration{5'000'000});
      smallest = std::min(smallest, robots.clearance_m(network.now()));
    }
    return smallest;
  }
  int arrived() {
    int count = 0;
    for (const RobotSpec& robot : scenario.robots) {
      const double to_go =
          (robots.position_m(robot.id, network.now()) - robot.goals.back().position_m).norm();
      count += to_go < scenario.goal_tolerance_m;
    }
    return count;
  }
};

Scenario crowd(int robots) {
  return parse_scenario(
      "field: {length_m: 8, width_m: 8}\ncircle: {count: " + std::to_string(robots) + ", spacing_m: 0.4}\n",
      "crowd.yaml");
}

}  // namespace

TEST_CASE("ideal robots keep their margin through loss, delay, duplicates and reordering") {
  Scenario scenario = crowd(12);
  struct Network {
    double loss, duplicate, delay_max_s;
  };
  const auto [loss, duplicate, delay_max_s] = GENERATE(Network{0, 0, 0.001}, Network{0.1, 0.05, 0.02},
                                                       Network{0.3, 0.2, 0.15}, Network{0.6, 0.5, 0.05});
  scenario.network.loss = loss;
  scenario.network.duplicate = duplicate;
  scenario.network.delay_min = Duration{0};
  scenario.network.delay_max = from_seconds(delay_max_s);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    CAPTURE(loss, duplicate, delay_max_s, seed);
    Ideal run(scenario, seed);
    const double clearance = run.run(15);
    REQUIRE(clearance >= scenario.margin_m);
    REQUIRE(run.watch.violations() == 0);
    if (loss == 0) REQUIRE(run.arrived() == 12);
  }
}

TEST_CASE("an undisturbed robot never brakes for want of a verdict") {
  Scenario scenario = parse_scenario(
      "field: {length_m: 8, width_m: 4}\nrobots:\n  - {id: 7, team: blue, start_m: [-3, 0], goals_m: [[3, "
      "0]]}\n",
      "alone.yaml");
  Ideal run(scenario, 1);
  const Time begin = run.network.now();
  Vec2 last = run.robots.position_m(7, begin);
  double speed = 0;
  int slower = 0;
  double peak = 0;
  while (run.arrived() == 0 && run.network.now() < begin + from_seconds(10)) {
    (void)run.run(0.02);
    const Vec2 here = run.robots.position_m(7, run.network.now());
    const double now_mps = (here - last).norm() / 0.02;
    // Braking on the way, before the one stop at the goal begins.
    slower += now_mps < speed - 0.02 && (here - Vec2(3, 0)).norm() > 0.55;
    peak = std::max(peak, now_mps);
    speed = now_mps;
    last = here;
  }
  CHECK(run.arrived() == 1);
  CHECK(slower == 0);
  CHECK(peak == Approx(scenario.limits.speed_mps).margin(0.02));
}

TEST_CASE("with equal wishes the same robot does not always lose") {
  // Two robots meet at right angles, at the same time but for a few centimetres.
  int won[2] = {0, 0};
  Rng rng(1);
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const std::uint64_t first_id = 1 + seed % 2;
    const auto text = [&](std::uint64_t id, const std::string& start, const std::string& goal) {
      return "  - {id: " + std::to_string(id) + ", team: blue, start_m: " + start + ", goals_m: [" + goal +
             "]}\n";
    };
    const std::string offset = std::to_string(-1.2 + rng.uniform(-0.05, 0.05));
    Ideal run(parse_scenario("field: {length_m: 4, width_m: 4}\nrobots:\n" +
                                 text(first_id, "[" + offset + ", 0]", "[1.2, 0]") +
                                 text(3 - first_id, "[0, -1.2]", "[0, 1.2]"),
                             "cross.yaml"),
              seed);
    (void)run.run(10);
    REQUIRE(run.arrived() == 2);
    Ideal again(run.scenario, seed);
    while (again.arrived() == 0) (void)again.run(0.02);
    for (const RobotSpec& robot : run.scenario.robots) {
      const Vec2 here = again.robots.position_m(robot.id, again.network.now());
      won[robot.id - 1] += (here - robot.goals.back().position_m).norm() < run.scenario.goal_tolerance_m;
    }
  }
  CAPTURE(won[0], won[1]);
  CHECK(won[0] >= 8);
  CHECK(won[1] >= 8);
}
