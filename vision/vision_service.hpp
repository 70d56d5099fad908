// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "vision/images/image_input.hpp"
#include "vision/images/image_options.hpp"
#include "vision/league/league_input.hpp"
#include "vision/league/tracked_output.hpp"
#include "vision/vision_node.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// What the vision service is asked for beyond the scenario.
struct VisionOptions {
  bool is_league_source = false;  ///< the league's packets instead of what the bus brings
  std::string league_vision = league::kVisionEndpoint;
  std::optional<std::string> tracked;  ///< tracked packets go there
  std::string league_interface = league::kLeagueInterface;
  ImageOptions images;
};

/// Adds --source, --ssl-vision, --tracked and --league-interface.
void add_league_options(CLI::App& app, VisionOptions& options);

/// The vision service with the sources and outputs that were asked for. The bus must not call back any more
/// when this has gone. Throws as MulticastReceiver, LeagueSource and image_reader() do.
class VisionService {
 public:
  VisionService(DdsBus& bus, const Scenario& scenario, Incarnation incarnation, const VisionOptions& options);
  VisionService(const VisionService&) = delete;
  VisionService& operator=(const VisionService&) = delete;

 private:
  VisionNode node_;
  std::optional<LeagueInput> league_;
  std::optional<ImageInput> images_;
  std::optional<TrackedOutput> tracked_;
  std::optional<league::MulticastSender> tracked_sender_;
};

}  // namespace sidestep
