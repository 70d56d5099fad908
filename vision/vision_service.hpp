// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/process/command_line.hpp"
#include "vision/images/image_input.hpp"
#include "vision/images/image_options.hpp"
#include "vision/league/league_input.hpp"
#include "vision/league/tracked_output.hpp"
#include "vision/tracking/vision_node.hpp"

namespace sidestep {

/// Options of the vision service beyond the scenario.
struct VisionOptions {
  bool is_league_source = false;  ///< detections come from the league's packets instead of the bus
  std::string league_vision = league::kVisionEndpoint;
  /// Cameras that together see the whole floor; empty: the scenario's.
  std::vector<std::uint32_t> league_cameras;
  std::optional<std::string> tracked;       ///< endpoint to which tracked packets are sent
  std::vector<std::string> league_senders;  ///< the only ones to use; empty: the first that is heard
  bool may_have_other_field = false;        ///< the sender's field may differ from the scenario's
  /// Packets are received on all of these interfaces, and sent over the first. Empty: the scenario's.
  std::vector<std::string> league_interfaces;
  ImageOptions images;
};

/// Adds --source and the options of the league's packets.
void add_league_options(const CliCommand& app, VisionOptions& options);

/// The vision service with the sources and outputs selected by the options. Precondition: the bus makes no
/// callbacks after the service's destruction. Throws what MulticastReceiver, LeagueSource and image_reader()
/// throw.
class VisionService {
 public:
  VisionService(DdsBus& bus, const Scenario& scenario, Incarnation incarnation, const VisionOptions& options);
  VisionService(const VisionService&) = delete;
  VisionService& operator=(const VisionService&) = delete;

  /// Sets a callback for events of level `min_level` or higher.
  void on_event(LogLevel min_level, OnLogEvent callback) { node_.on_event(min_level, std::move(callback)); }

 private:
  VisionNode node_;
  std::optional<LeagueInput> league_;
  std::optional<ImageInput> images_;
  std::optional<TrackedOutput> tracked_;
  std::optional<league::MulticastSender> tracked_sender_;
};

}  // namespace sidestep
