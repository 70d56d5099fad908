// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <stdexcept>

#include "common/log/log.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "common/protocol/moving_text.hpp"
#include "common/protocol/senders.hpp"
#include "simulator/bases/base_options.hpp"
#include "simulator/bases/league_server.hpp"
#include "simulator/bases/velocity_server.hpp"
#include "simulator/images/image_output.hpp"
#include "simulator/league/league_output.hpp"
#include "simulator/world/simulator_node.hpp"

namespace sidestep {
namespace {

struct Options {
  std::uint64_t seed = 1;
  std::optional<std::string> ssl_vision;
  std::string league_interface = league::kLeagueInterface;
  BaseOptions bases;
};

void add_options(const CliCommand& app, Options& options) {
  app.add_option("--seed", options.seed, "seed of all noise and loss").show_default();
  app.add_optional_value("--ssl-vision", options.ssl_vision, league::kSimulatedVisionEndpoint,
                         "also send SSL-Vision packets, to this ADDRESS:PORT");
  app.add_option("--league-interface", options.league_interface,
                 "address of the network interface for league packets")
      .show_default();
  add_base_options(app, options.bases);
}

/// Robots with Sidestep's firmware.
struct Robots {
  Robots(Bus& bus, const Scenario& scenario, const Options& options, Incarnation incarnation)
      : simulator(bus, scenario, incarnation, options.seed) {
    if (scenario.vision.images) images.emplace(bus, scenario, simulator, incarnation, options.seed);
    if (!options.ssl_vision) return;
    league.emplace(bus, simulator.events(), scenario, simulator.cameras().views(), *options.ssl_vision,
                   options.league_interface);
    simulator.set_detection_listener([this](const msg::DetectionFrame& frame) { league->send(frame); });
    simulator.add_drop_source([this](DropCounters& drops) { league->count_drops(drops); });
  }
  SimulatorNode simulator;
  std::optional<ImageOutput> images;
  std::optional<LeagueOutput> league;
};

/// Robots that clients drive through the league's protocol.
struct LeagueRobots {
  LeagueRobots(DdsBus& bus, const Scenario& scenario, const Options& options, Incarnation incarnation)
      : bases(bus, scenario, settings_of(options.bases), incarnation, options.seed),
        server(bases, ports_of(options.bases), options.bases.server),
        vision(bus, bases.events(), reported_floor(bases.world_now().floor(), options.bases),
               bases.cameras().views(), options.ssl_vision.value_or(league::kSimulatedVisionEndpoint),
               options.league_interface, traits_of(options.bases)) {
    bases.set_detection_listener([this](const msg::DetectionFrame& frame, Time captured) {
      const Time begin = bases.simulated_begin();
      vision.send(frame, {captured - begin, bases.simulated_now() - begin});
    });
    bases.add_drop_source([this](DropCounters& drops) { vision.count_drops(drops); });
    server.start([&bus](int descriptor, std::function<void()> readable) {
      bus.watch(descriptor, std::move(readable));
    });
  }
  VelocityRobotSimNode bases;
  LeagueServer server;
  LeagueOutput vision;
};

/// Robots that appear as bases with ROS 2's topics.
struct VelocityRobots {
  VelocityRobots(DdsBus& bus, const Scenario& scenario, const Options& options, Incarnation incarnation)
      : bases(bus, scenario, settings_of(options.bases), incarnation, options.seed),
        velocity_bus(bases_bus(bus, options.bases.velocity)),
        server(*velocity_bus, bases, options.bases.velocity.topic_prefix, options.bases.odometry_drift) {}
  VelocityRobotSimNode bases;
  std::shared_ptr<Bus> velocity_bus;
  VelocityServer server;
};

void require_plain_vision(const Scenario& scenario) {
  if (scenario.vision.images || scenario.laser)
    throw std::invalid_argument("robots without firmware have neither images nor lasers, but scenario " +
                                scenario.name + " asks for them");
}

RunningNodes start_velocity(DdsBus& bus, const Scenario& scenario, const Options& options,
                            Incarnation incarnation) {
  require_plain_vision(scenario);
  auto nodes = std::make_shared<VelocityRobots>(bus, scenario, options, incarnation);
  log_events_of(nodes->bases);
  return {nodes, {}};
}

RunningNodes start_robots(Bus& bus, const Scenario& scenario, const Options& options,
                          Incarnation incarnation) {
  auto nodes = std::make_shared<Robots>(bus, scenario, options, incarnation);
  log_events_of(nodes->simulator);
  return {nodes, [&nodes = *nodes] { return nodes.simulator.is_commanded(); },
          [&nodes = *nodes] { return nodes.simulator.come_to_rest(); },
          [&nodes = *nodes] { return still_moving_text(nodes.simulator.moving_robots()); }};
}

RunningNodes start_league(DdsBus& bus, const Scenario& scenario, const Options& options,
                          Incarnation incarnation) {
  require_plain_vision(scenario);
  auto nodes = std::make_shared<LeagueRobots>(bus, scenario, options, incarnation);
  log_events_of(nodes->bases);
  return {nodes, {}};
}

}  // namespace
}  // namespace sidestep

int main(int argc, char** argv) {
  sidestep::Options options;
  sidestep::Program program;
  program.name = "sidestep-simulator";
  program.description =
      "Simulates the floor: robot bodies and their firmware, the ball, opponents, and the cameras above.";
  program.add_options = [&options](const sidestep::CliCommand& app) { sidestep::add_options(app, options); };
  program.process = [] { return static_cast<std::uint32_t>(sidestep::Sender::kSimulator); };
  program.start = [&options](sidestep::DdsBus& bus, const sidestep::Scenario& scenario,
                             sidestep::Incarnation incarnation) -> sidestep::RunningNodes {
    check(options.bases);
    if (options.bases.is_league) return sidestep::start_league(bus, scenario, options, incarnation);
    if (options.bases.is_velocity) return sidestep::start_velocity(bus, scenario, options, incarnation);
    return sidestep::start_robots(bus, scenario, options, incarnation);
  };
  return sidestep::run_process(argc, argv, program);
}
