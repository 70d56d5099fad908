// SPDX-License-Identifier: Apache-2.0
#include "vision/vision_service.hpp"

#include <CLI/CLI.hpp>

#include "common/process/process.hpp"

namespace sidestep {
namespace {

FrameSource source_of(const Scenario& scenario, const VisionOptions& options) {
  const bool is_bus = !options.is_league_source && !scenario.vision.images;
  return is_bus ? FrameSource::kBus : FrameSource::kCaller;
}

}  // namespace

void add_league_options(CLI::App& app, VisionOptions& options) {
  CLI::Option* const source =
      app.add_option_function<std::string>(
             "--source", [&options](const std::string& name) { options.is_league_source = name == "ssl"; },
             "where frames come from: the cameras over DDS, or SSL-Vision's multicast")
          ->check(CLI::IsMember({"dds", "ssl"}))
          ->default_str("dds");
  app.add_option("--ssl-vision", options.league_vision, "ADDRESS:PORT of SSL-Vision's packets")
      ->needs(source)
      ->capture_default_str();
  add_optional_value(app, "--tracked", options.tracked, league::kTrackedEndpoint,
                     "publish tracked packets, at this ADDRESS:PORT");
  app.add_option("--league-interface", options.league_interface,
                 "address of the network interface for the league's packets")
      ->capture_default_str();
}

VisionService::VisionService(DdsBus& bus, const Scenario& scenario, Incarnation incarnation,
                             const VisionOptions& options)
    : node_(bus, scenario, incarnation, source_of(scenario, options)) {
  if (options.is_league_source) {
    league_.emplace(bus, scenario, LeagueAddress{options.league_vision, options.league_interface}, node_);
  } else if (scenario.vision.images) {
    images_.emplace(bus, image_reader(scenario, options.images), node_);
  }
  if (!options.tracked) return;
  tracked_.emplace(scenario, incarnation);
  tracked_sender_.emplace(league::multicast_endpoint(*options.tracked), options.league_interface);
  node_.set_listener([this](const msg::WorldState& world) {
    tracked_sender_->send(league::encode(tracked_->packet_of(world)));
  });
}

}  // namespace sidestep
