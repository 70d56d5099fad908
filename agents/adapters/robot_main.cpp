// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agents/adapters/league/league_driver.hpp"
#include "agents/adapters/robot_driver_node.hpp"
#include "agents/adapters/robot_list.hpp"
#include "agents/adapters/skeleton/skeleton_camera.hpp"
#include "agents/adapters/skeleton/skeleton_driver.hpp"
#include "agents/adapters/velocity/velocity_driver.hpp"
#include "common/log/log.hpp"
#include "common/process/bases_bus.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/protocol/moving_text.hpp"
#include "common/protocol/senders.hpp"

namespace sidestep {
namespace {

struct Options {
  std::string driver;
  std::string robots = "all";
  std::string memory_folder = default_memory_folder();
  double latency_ms = 100;
  double turn_radps = DriveSettings{}.turn_radps;
  BasesBusOptions bases;
  std::string blue = "127.0.0.1:10301", yellow = "127.0.0.1:10302";
};

/// What a driver may be made of.
struct DriverParts {
  DdsBus& bus;
  Bus* bases;  ///< null unless the driver is "velocity"
  const Scenario& scenario;
  const std::vector<RobotId>& robots;
  const Options& options;
};

std::unique_ptr<Driver> make_league_driver(const DriverParts& parts) {
  const LeaguePorts ports{league::parse_unicast_endpoint(parts.options.blue),
                          league::parse_unicast_endpoint(parts.options.yellow)};
  auto driver = std::make_unique<LeagueDriver>(parts.scenario, parts.robots, ports);
  parts.bus.watch(driver->descriptor(), [driver = driver.get()] { driver->receive(); });
  log_events_of(*driver);
  return driver;
}

std::unique_ptr<Driver> make_velocity_driver(const DriverParts& parts) {
  return std::make_unique<VelocityDriver>(*parts.bases, parts.robots, parts.options.bases.topic_prefix);
}

std::unique_ptr<Driver> make_skeleton_driver(const DriverParts& parts) {
  return std::make_unique<SkeletonDriver>(parts.robots, [&bus = parts.bus] { return bus.now(); });
}

struct NamedDriver {
  std::string_view name;
  std::unique_ptr<Driver> (*make)(const DriverParts& parts);
};
/// All drivers.
constexpr std::array kDrivers{NamedDriver{"league", make_league_driver},
                              NamedDriver{"velocity", make_velocity_driver},
                              NamedDriver{"skeleton", make_skeleton_driver}};

std::vector<std::string> driver_names() {
  std::vector<std::string> names;
  for (const NamedDriver& driver : kDrivers) names.emplace_back(driver.name);
  return names;
}

/// Precondition: the option --driver is one of driver_names().
std::unique_ptr<Driver> make_driver(const DriverParts& parts) {
  return std::ranges::find(kDrivers, parts.options.driver, &NamedDriver::name)->make(parts);
}

void add_options(const CliCommand& app, Options& options) {
  app.add_option(
         "--driver", options.driver,
         "driver that moves the robots: league, velocity; skeleton: ideal bases, the template for drivers")
      .check(one_of(driver_names()))
      .required();
  app.add_option("--robots", options.robots, "numbers and ranges of the scenario's robots, such as 0-10,16")
      .show_default();
  app.add_option("--latency-ms", options.latency_ms, "time from a command until the base moves accordingly")
      .check(in_range(0, static_cast<double>(to_seconds(CommandedMotion::kMaxLatency) * 1e3)))
      .show_default();
  app.add_option("--turn-speed", options.turn_radps,
                 "speed at which robots turn, rad/s; bases must be able to turn as fast")
      .check(in_range(0.1, 20))
      .show_default();
  app.add_option("--memory", options.memory_folder,
                 "folder for the robots' memories, which must survive restarts of this program")
      .show_default();
  add_bases_bus_options(app, "driver velocity", options.bases);
  app.add_option("--blue", options.blue, "driver league: ADDRESS:PORT for the blue team's commands")
      .show_default();
  app.add_option("--yellow", options.yellow, "driver league: ADDRESS:PORT for the yellow team's commands")
      .show_default();
}

DriveSettings settings_of(const Scenario& scenario, const Options& options) {
  DriveSettings settings = drive_settings(scenario, from_seconds(options.latency_ms * 1e-3));
  settings.turn_radps = options.turn_radps;
  return settings;
}

struct Nodes {
  Nodes(DdsBus& bus, const Scenario& scenario, Incarnation incarnation, const Options& options)
      : robots(select_robots(scenario, options.robots)),
        bases(options.driver == "velocity" ? bases_bus(bus, options.bases) : nullptr),
        driver(make_driver({bus, bases.get(), scenario, robots, options})),
        node(bus, scenario, robots, incarnation, settings_of(scenario, options), *driver,
             options.memory_folder) {
    if (const auto* skeleton = dynamic_cast<const SkeletonDriver*>(driver.get()))
      camera.emplace(bus, scenario, robots, *skeleton, incarnation);
  }
  std::vector<RobotId> robots;
  std::shared_ptr<Bus> bases;
  std::unique_ptr<Driver> driver;
  RobotDriverNode node;
  std::optional<SkeletonCamera> camera;  ///< only ideal bases need one
};

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  using namespace sidestep;
  Options options;
  Program program;
  program.name = "sidestep-robot";
  program.description =
      "Drives real robots, or robots of another simulator: the robots' side of the safety protocol.";
  program.add_options = [&options](const CliCommand& app) { add_options(app, options); };
  program.participant = [] { return "robots"; };
  program.process = [] { return static_cast<std::uint32_t>(Sender::kRobots); };
  program.start = [&options](DdsBus& bus, const Scenario& scenario, Incarnation incarnation) -> RunningNodes {
    auto nodes = std::make_shared<Nodes>(bus, scenario, incarnation, options);
    log_events_of(nodes->node);
    return {nodes, [&node = nodes->node] { return node.is_commanded(); },
            [&node = nodes->node] { return node.come_to_rest(); },
            [&node = nodes->node] { return still_moving_text(node.moving_robots()); }};
  };
  return run_process(argc, argv, program);
}
