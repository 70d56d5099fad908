// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/safety/safety_search.hpp"
#include "common/config/scenario.hpp"

namespace sidestep::bench {

/// A snapshot of a thousand robots in crossing streams: the contents of the coordinator's ledger, and the
/// next search query of each robot.
struct Snapshot {
  Scenario scenario;
  struct Robot {
    SearchQuery query;
    std::vector<Version> versions;
  };
  std::vector<Robot> robots;  ///< in order of their distance from the centre of the field
};

/// A snapshot of a simulation of deploy/scenarios/streams-1000.yaml, two seconds after the first grant.
const Snapshot& crossing_streams();

}  // namespace sidestep::bench
