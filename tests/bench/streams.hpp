// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/safety/safety_search.hpp"
#include "common/config/scenario.hpp"

namespace sidestep::bench {

/// An instant of a thousand robots in crossing streams: everything that the coordinator's ledger holds, and
/// what each robot is about to search for.
struct Snapshot {
  Scenario scenario;
  struct Robot {
    SearchQuery query;
    std::vector<Version> versions;
  };
  std::vector<Robot> robots;  ///< those nearest to the middle of the floor first
};

/// From a simulation of deploy/scenarios/streams-1000.yaml, two seconds after its robots began to move.
const Snapshot& crossing_streams();

}  // namespace sidestep::bench
