// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/sim_bus.hpp"
#include "common/motion/version.hpp"

namespace sidestep {

/// Checks the ledger's invariant on what the coordinator publishes, with simpler code than the coordinator's:
/// it samples every pair of versions of different robots in time. Robots that lost their reference may be
/// near to others until they are clear of all again.
class LedgerWatch {
 public:
  LedgerWatch(SimNetwork& network, const Scenario& scenario);

  std::uint64_t pages() const { return pages_; }
  /// Pairs of versions found nearer than both radii, the margin and both growths.
  std::uint64_t violations() const { return violations_; }

 private:
  void check(const msg::LedgerPage& page);
  bool are_near(const Version& a, const Version& b) const;

  SimBus bus_;
  double keep_m_;
  std::map<RobotId, Time> off_reference_;  // robots that lost it and were not clear of all since, and when
  std::uint64_t pages_ = 0, violations_ = 0;
};

}  // namespace sidestep
