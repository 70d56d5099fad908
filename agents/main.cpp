// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <stdexcept>
#include <string>

#include "agents/agent/agent_node.hpp"
#include "common/config/planner_names.hpp"
#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/protocol/moving_text.hpp"

int main(int argc, char** argv) {
  using namespace sidestep;
  RobotId robot = 0;
  std::string planner;
  Program program;
  program.name = "sidestep-agent";
  program.description = "Drives one robot: plans its route and negotiates every motion with the coordinator.";
  program.add_options = [&](const CliCommand& app) {
    app.add_option("--robot", robot, "id of the robot in the scenario").required();
    app.add_option("--planner", planner, "path planner of the robot [the scenario's]")
        .check(one_of(driving_planners()));
  };
  program.participant = [&] { return "agent-" + std::to_string(robot); };
  program.process = [&] { return robot; };
  program.start = [&](Bus& bus, const Scenario& given, Incarnation incarnation) -> RunningNodes {
    Scenario scenario = given;
    use_planner(scenario, planner);
    if (!find_robot(scenario, robot)) {
      throw std::invalid_argument("--robot: scenario " + scenario.name + " has no robot " +
                                  std::to_string(robot));
    }
    auto node = std::make_shared<AgentNode>(bus, scenario, robot, incarnation,
                                            std::make_shared<PlanningScratch>(scenario));
    log_events_of(*node);
    return {node, [&node = *node] { return node.uses_clock(); },
            [&node = *node] { return node.come_to_rest(); },
            [&node = *node, robot] { return node.is_at_rest() ? "" : still_moving_text(std::array{robot}); }};
  };
  return run_process(argc, argv, program);
}
