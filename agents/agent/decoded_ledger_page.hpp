// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/motion/trajectory_bounds.hpp"
#include "common/motion/version.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// A decoded page of the ledger, with quantities that depend on a single version only. It is the same for all
/// agents, so the agents of one process can share it.
struct DecodedLedgerPage {
  struct Entry {
    Vec2 position_m;  ///< start position of the version, as stated on the page
    RobotId robot;
    bool is_valid;  ///< if false, the version could not be decoded
  };

  /// Decodes an untrusted page. Allocates nothing once warm.
  void assign(const msg::LedgerPage& page);

  // In the order of the page's versions.
  std::vector<Entry> entries;
  std::vector<Version> versions;
  std::vector<TrajectoryBounds> bounds;
  std::vector<Time> ends;
};

}  // namespace sidestep
