// SPDX-License-Identifier: Apache-2.0
#include <optional>

#include "common/log/log.hpp"
#include "common/messaging/senders.hpp"
#include "common/process/command_line.hpp"
#include "common/process/process.hpp"
#include "simulator/images/image_output.hpp"
#include "simulator/league/league_output.hpp"

namespace sidestep {
namespace {

/// The multicast address of simulators, distinct from that of real cameras.
constexpr const char* kSimulatedVision = "224.5.23.2:10020";

struct Options {
  std::uint64_t seed = 1;
  std::optional<std::string> ssl_vision;
  std::string league_interface = league::kLeagueInterface;
};

void add_options(const CliCommand& app, Options& options) {
  app.add_option("--seed", options.seed, "seed of all noise and loss").show_default();
  app.add_optional_value("--ssl-vision", options.ssl_vision, kSimulatedVision,
                         "also send SSL-Vision packets, to this ADDRESS:PORT");
  app.add_option("--league-interface", options.league_interface,
                 "address of the network interface for league packets")
      .show_default();
}

struct Nodes {
  Nodes(Bus& bus, const Scenario& scenario, const Options& options, Incarnation incarnation)
      : simulator(bus, scenario, incarnation, options.seed) {
    if (scenario.vision.images) images.emplace(bus, scenario, simulator, incarnation, options.seed);
    if (options.ssl_vision)
      league.emplace(bus, scenario, simulator, *options.ssl_vision, options.league_interface);
  }
  SimulatorNode simulator;
  std::optional<ImageOutput> images;
  std::optional<LeagueOutput> league;
};

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
  program.start = [&options](sidestep::Bus& bus, const sidestep::Scenario& scenario,
                             sidestep::Incarnation incarnation) -> sidestep::RunningNodes {
    auto nodes = std::make_shared<sidestep::Nodes>(bus, scenario, options, incarnation);
    sidestep::log_events_of(nodes->simulator);
    return {nodes, [&nodes = *nodes] { return nodes.simulator.is_commanded(); }};
  };
  return sidestep::run_process(argc, argv, program);
}
