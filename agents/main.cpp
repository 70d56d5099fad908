// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "agents/agent/agent_node.hpp"
#include "common/log/log.hpp"
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
  program.start = [&](Bus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    if (!find_robot(scenario, robot)) {
      throw std::invalid_argument("--robot: scenario " + scenario.name + " has no robot " +
                                  std::to_string(robot));
    }
    auto node = std::make_shared<AgentNode>(bus, scenario, robot, incarnation,
                                            std::make_shared<PlanningScratch>(scenario));
    log_events_of(*node);
    return {node, [&node = *node] { return node.uses_clock(); }};
  };
  return run_process(argc, argv, program);
}
