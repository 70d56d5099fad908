// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/place/league_command.hpp"

#include <memory>

#include "common/config/scenario_loader.hpp"
#include "deploy/run/place/place_floor.hpp"

namespace sidestep {
namespace {

struct PlaceCommand {
  std::string scenario_file;
  PlaceOptions options;
};

}  // namespace

void add_league_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand simulator = root.add_subcommand("league", "Controls a simulator of the Small Size League");
  simulator.require_subcommand();
  const auto place = std::make_shared<PlaceCommand>();
  const CliCommand command = simulator.add_subcommand(
      "place",
      "Places the scenario's robots and ball, removes all other robots, and waits until vision agrees");
  command.add_option("SCENARIO", place->scenario_file, "scenario file, see deploy/scenarios/README.md")
      .required();
  command.add_option("--control", place->options.control, "ADDRESS:PORT of the simulator's control port")
      .show_default();
  command
      .add_option("--ssl-vision", place->options.vision,
                  "ADDRESS:PORT of the multicast group of vision packets")
      .show_default();
  command
      .add_option("--league-interface", place->options.interfaces,
                  "addresses of the network interfaces on which vision packets are received, or 'all'")
      .comma_separated()
      .show_default("the scenario's vision.league_interfaces");
  command
      .add_option("--league-sender", place->options.senders,
                  "ADDRESS or ADDRESS:PORT of the only senders whose vision packets are used")
      .comma_separated()
      .show_default("the first that is heard");
  command.add_option("--seconds", place->options.timeout_s, "give up after this time")
      .check(positive())
      .show_default();
  command.on_parsed([place, &action] {
    action = [place] { return place_floor(load_scenario(place->scenario_file), place->options); };
  });
}

}  // namespace sidestep
