// SPDX-License-Identifier: Apache-2.0
#include "vision/league/league_vision.hpp"

#include <CLI/CLI.hpp>

#include "common/process/process.hpp"

namespace sidestep {

void add_league_options(CLI::App& app, LeagueOptions& options) {
  CLI::Option* const source =
      app.add_option_function<std::string>(
             "--source", [&options](const std::string& name) { options.is_source = name == "ssl"; },
             "where frames come from: the simulator's cameras over DDS, or SSL-Vision's multicast")
          ->check(CLI::IsMember({"dds", "ssl"}))
          ->default_str("dds");
  app.add_option("--ssl-vision", options.vision, "ADDRESS:PORT of SSL-Vision's packets")
      ->needs(source)
      ->capture_default_str();
  add_optional_value(app, "--tracked", options.tracked, league::kTrackedEndpoint,
                     "publish tracked packets, at this ADDRESS:PORT");
  app.add_option("--league-interface", options.interface,
                 "address of the network interface for the league's packets")
      ->capture_default_str();
}

LeagueVision::LeagueVision(DdsBus& bus, const Scenario& scenario, Incarnation incarnation,
                           const LeagueOptions& options)
    : node_(bus, scenario, incarnation, options.is_source ? FrameSource::kCaller : FrameSource::kBus) {
  if (options.is_source)
    input_.emplace(bus, scenario, LeagueAddress{options.vision, options.interface}, node_);
  if (!options.tracked) return;
  tracked_.emplace(scenario, incarnation);
  tracked_sender_.emplace(league::multicast_endpoint(*options.tracked), options.interface);
  node_.set_listener([this](const msg::WorldState& world) {
    tracked_sender_->send(league::encode(tracked_->packet_of(world)));
  });
}

}  // namespace sidestep
