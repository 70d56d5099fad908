// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/motion/trajectory_bounds.hpp"
#include "common/motion/version.hpp"
#include "idl/negotiation.h"

namespace sidestep {

/// A page of the ledger as agents need it: decoded, and with what is computed from each version alone. It is
/// the same for all agents, so those of one process can share it.
struct LedgerView {
  /// Where a version begins, as the page says; the version itself makes no sense where it is not sound.
  struct Entry {
    Vec2 place_m;
    RobotId robot;
    bool is_sound;
  };

  /// Allocates nothing once warm.
  void assign(const msg::LedgerPage& page);

  // All four as the page's versions.
  std::vector<Entry> entries;
  std::vector<Version> versions;
  std::vector<TrajectoryBounds> outlines;
  std::vector<Time> ends;
};

}  // namespace sidestep
