// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <stdexcept>

#include "agents/agent/agent_node.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  RobotId robot = 0;
  Program program;
  program.name = "sidestep-agent";
  program.description = "Drives one robot: plans its route and negotiates every motion with the coordinator.";
  program.add_options = [&](const CliCommand& app) {
    app.add_option("--robot", robot, "id of the robot in the scenario").required();
  };
  program.participant = [&] { return "agent-" + std::to_string(robot); };
  program.process = [&] { return robot; };
  program.start = [&](Bus& bus, const Scenario& scenario) -> std::shared_ptr<void> {
    if (!find_robot(scenario, robot)) {
      throw std::invalid_argument("--robot: scenario " + scenario.name + " has no robot " +
                                  std::to_string(robot));
    }
    const auto incarnation = static_cast<Incarnation>(to_ns(bus.now()));
    auto node = std::make_shared<AgentNode>(bus, scenario, robot, incarnation,
                                            std::make_shared<PlanningScratch>(scenario));
    // The process keeps running: if it exited, a supervisor would restart it, and the new instance would take
    // the robot from the later agent.
    node->on_superseded([robot](bool is_superseded) {
      fmt::print(stderr, "agent-{}: {}\n", robot,
                 is_superseded ? "superseded: a later agent drives this robot; this one stays silent"
                               : "the robot obeys this agent after all");
    });
    return node;
  };
  return run_process(argc, argv, program);
}
