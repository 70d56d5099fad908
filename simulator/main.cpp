// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <optional>

#include "common/messaging/senders.hpp"
#include "common/process/process.hpp"
#include "simulator/images/image_output.hpp"
#include "simulator/league/league_output.hpp"

namespace sidestep {
namespace {

/// Simulators send where no real cameras do.
constexpr const char* kSimulatedVision = "224.5.23.2:10020";

struct Options {
  std::uint64_t seed = 1;
  std::optional<std::string> ssl_vision;
  std::string league_interface = league::kLeagueInterface;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("--seed", options.seed, "of all noise and loss")->capture_default_str();
  add_optional_value(app, "--ssl-vision", options.ssl_vision, kSimulatedVision,
                     "send SSL-Vision's packets too, to this ADDRESS:PORT");
  app.add_option("--league-interface", options.league_interface,
                 "address of the network interface for the league's packets")
      ->capture_default_str();
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
  program.description = "The floor: robot bodies and their firmware, the ball, and the cameras over it.";
  program.add_options = [&options](CLI::App& app) { sidestep::add_options(app, options); };
  program.fault_target = [] { return static_cast<std::uint32_t>(sidestep::Sender::kSimulator); };
  program.start = [&options](sidestep::Bus& bus,
                             const sidestep::Scenario& scenario) -> std::shared_ptr<void> {
    return std::make_shared<sidestep::Nodes>(bus, scenario, options,
                                             static_cast<sidestep::Incarnation>(sidestep::to_ns(bus.now())));
  };
  return sidestep::run_process(argc, argv, program);
}
