// SPDX-License-Identifier: Apache-2.0
#include "common/config/scenario_loader.hpp"
#include "tests/catch.hpp"
#include "tests/sim/ideal_floor.hpp"

namespace sidestep::twin_agents_test {

/// Counts the messages of one robot's agents, by incarnation.
struct AgentTraffic {
  AgentTraffic(IdealFloor& floor, RobotId robot) : bus(floor.network) {
    const auto count = [this, robot](const auto& message) {
      if (message.robot() == robot) ++messages[message.header().incarnation()];
    };
    bus.subscribe<msg::AgentStatus>(topics::kStatus, count);
    bus.subscribe<msg::Proposal>(topics::kProposal, count);
    bus.subscribe<msg::Registration>(topics::kRegistration, count);
    bus.subscribe<msg::Command>(topics::kCommand, robot, count);
  }
  SimBus bus;
  std::map<Incarnation, int> messages;
};

TEST_CASE("if a robot has two agents, the agent started later drives the robot and keeps clearances") {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    CAPTURE(seed);
    Scenario scenario = parse_scenario(
        "coordinators: 2\nfield: {length_m: 8, width_m: 8}\ncircle: {count: 8, spacing_m: 0.5}\n",
        "twins.yaml");
    if (seed % 3 == 0) {
      scenario.network.loss = 0.15;
      scenario.network.duplicate = 0.1;
      scenario.network.delay_max = std::chrono::milliseconds(40);
    }
    IdealFloor floor(scenario, seed);
    Rng rng(seed);
    AgentTraffic traffic(floor, 3);
    double clearance = floor.run(rng.uniform(0.9, 2.5));
    for (int twin = 0; twin < 3; ++twin) {
      floor.start_agent(3);
      clearance = std::min(clearance, floor.run(rng.uniform(0.01, 0.6)));
      if (twin == 1) floor.kill_coordinator(0);
      // The first agent may receive nothing for a while, and then does not notice the new agent.
      FaultyBus& earlier = *floor.agent_buses(3).front();
      earlier.block_incoming(rng.chance(0.5));
      clearance = std::min(clearance, floor.run(rng.uniform(0.01, 0.6)));
      earlier.block_incoming(false);
    }
    clearance = std::min(clearance, floor.run_until_arrived(30));
    REQUIRE(clearance >= scenario.margin_m);
    REQUIRE(floor.arrived() == 8);
    REQUIRE(floor.violations() == 0);
    REQUIRE(floor.unknown_versions() == 0);
    (void)floor.run(1);
    REQUIRE(traffic.messages.size() == 4);
    const auto before = traffic.messages;
    // After the robot has been pushed away from its goal, only the last agent may send messages.
    floor.robots.push(3, -0.3 * floor.robots.position_m(3, floor.network.now()).normalized(), {0, 0});
    (void)floor.run_until_arrived(10);
    CHECK(floor.arrived() == 8);
    for (const auto& [incarnation, count] : before) {
      const bool is_last = incarnation == before.rbegin()->first;
      CHECK((traffic.messages[incarnation] > count) == is_last);
    }
  }
}

}  // namespace sidestep::twin_agents_test
