// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"

namespace sidestep {

/// Checks the ledger's invariant on what the coordinator publishes, with simpler code than the coordinator's:
/// it samples every pair of versions of different robots in time.
class LedgerWatch {
 public:
  LedgerWatch(Bus& bus, const Scenario& scenario);

  std::uint64_t pages() const { return pages_; }
  /// Pairs of versions found nearer than both radii and the margin.
  std::uint64_t violations() const { return violations_; }

 private:
  void check(const msg::LedgerPage& page);

  double keep_m_;
  std::uint64_t pages_ = 0, violations_ = 0;
};

}  // namespace sidestep
