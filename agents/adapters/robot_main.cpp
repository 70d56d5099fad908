// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "agents/adapters/league/league_driver.hpp"
#include "agents/adapters/robot_list.hpp"
#include "agents/adapters/robots_node.hpp"
#include "common/log/log.hpp"
#include "common/messaging/senders.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"

namespace sidestep {
namespace {

struct Options {
  std::string driver;
  std::string robots = "all";
  std::string memory_folder = default_memory_folder();
  double latency_ms = 100;
  std::string blue = "127.0.0.1:10301", yellow = "127.0.0.1:10302";
};

void add_options(const CliCommand& app, Options& options) {
  app.add_option("--driver", options.driver, "how the robots are moved: league")
      .check(one_of({"league"}))
      .required();
  app.add_option("--robots", options.robots, "numbers and ranges of the scenario's robots, such as 0-10,16")
      .show_default();
  app.add_option("--latency-ms", options.latency_ms, "time from a command until the base moves accordingly")
      .check(in_range(0, static_cast<double>(to_seconds(CommandedMotion::kMaxLatency) * 1e3)))
      .show_default();
  app.add_option("--memory", options.memory_folder,
                 "folder of what the robots must remember when this program restarts")
      .show_default();
  app.add_option("--blue", options.blue, "driver league: ADDRESS:PORT for the blue team's commands")
      .show_default();
  app.add_option("--yellow", options.yellow, "driver league: ADDRESS:PORT for the yellow team's commands")
      .show_default();
}

struct Nodes {
  Nodes(DdsBus& bus, const Scenario& scenario, Incarnation incarnation, const Options& options)
      : robots(select_robots(scenario, options.robots)),
        driver(
            scenario, robots,
            {league::parse_unicast_endpoint(options.blue), league::parse_unicast_endpoint(options.yellow)}),
        node(bus, scenario, robots, incarnation,
             drive_settings(scenario, from_seconds(options.latency_ms * 1e-3)), driver,
             options.memory_folder) {
    bus.watch(driver.descriptor(), [this] { driver.receive(); });
  }
  std::vector<RobotId> robots;
  LeagueDriver driver;
  RobotsNode node;
};

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  using namespace sidestep;
  Options options;
  Program program;
  program.name = "sidestep-robot";
  program.description =
      "Drives real robots, or those of a foreign simulator: their side of the safety protocol.";
  program.add_options = [&options](const CliCommand& app) { add_options(app, options); };
  program.participant = [] { return "robots"; };
  program.process = [] { return static_cast<std::uint32_t>(Sender::kRobots); };
  program.start = [&options](DdsBus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    auto nodes = std::make_shared<Nodes>(bus, scenario, incarnation, options);
    log_events_of(nodes->node);
    log_events_of(nodes->driver);
    return {nodes, [&nodes = *nodes] { return nodes.node.is_commanded(); }};
  };
  return run_process(argc, argv, program);
}
