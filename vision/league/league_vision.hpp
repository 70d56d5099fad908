// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "vision/league/league_input.hpp"
#include "vision/league/tracked_output.hpp"
#include "vision/vision_node.hpp"

namespace CLI {
class App;
}

namespace sidestep {

/// What sidestep-vision has to do with the league's packets: nothing, unless asked.
struct LeagueOptions {
  bool is_source = false;  ///< the league's packets instead of the bus's frames
  std::string vision = league::kVisionEndpoint;
  std::optional<std::string> tracked;  ///< tracked packets go there
  std::string interface = league::kLeagueInterface;
};

/// Adds --source, --ssl-vision, --tracked and --league-interface.
void add_league_options(CLI::App& app, LeagueOptions& options);

/// The vision service with the sources and outputs that were asked for. The bus must not call back any more
/// when this has gone. Throws as MulticastReceiver and LeagueSource do.
class LeagueVision {
 public:
  LeagueVision(DdsBus& bus, const Scenario& scenario, Incarnation incarnation, const LeagueOptions& options);
  LeagueVision(const LeagueVision&) = delete;
  LeagueVision& operator=(const LeagueVision&) = delete;

 private:
  VisionNode node_;
  std::optional<LeagueInput> input_;
  std::optional<TrackedOutput> tracked_;
  std::optional<league::MulticastSender> tracked_sender_;
};

}  // namespace sidestep
