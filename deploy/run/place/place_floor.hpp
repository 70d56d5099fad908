// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/league/multicast.hpp"

namespace sidestep {

inline constexpr const char* kLeagueControlEndpoint = "127.0.0.1:10300";

struct PlaceOptions {
  std::string control = kLeagueControlEndpoint;           ///< ADDRESS:PORT of the simulator's control port
  std::string vision = league::kSimulatedVisionEndpoint;  ///< ADDRESS:PORT of the multicast group
  std::vector<std::string> interfaces;  ///< addresses or "all"; empty: what the scenario says
  std::vector<std::string> senders;     ///< the only senders to use, see SenderChoice; empty: the first
  double timeout_s = 15;
};

/// Places the scenario's robots and ball on a floor that a simulator of the league simulates, removes all
/// other robots, and waits until vision agrees. Prints the outcome. Returns 0, or kExitFailure if vision does
/// not agree in time or the user interrupts. Throws std::invalid_argument if an address is invalid, and
/// std::runtime_error if a socket cannot be opened.
[[nodiscard]] int place_floor(const Scenario& scenario, const PlaceOptions& options);

}  // namespace sidestep
