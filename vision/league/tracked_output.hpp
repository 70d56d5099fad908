// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "common/league/tracked_packet.hpp"
#include "idl/vision.hpp"

namespace sidestep {

/// Converts worlds to the league's tracked packets, which have no obstacles.
class TrackedOutput {
 public:
  /// The sender's UUID is derived from the incarnation. Throws std::invalid_argument if two robots of the
  /// scenario have the same team and number.
  TrackedOutput(const Scenario& scenario, Incarnation incarnation);

  /// The packet for a world; valid until the next call. A robot that was not observed in the last 100 ms is
  /// reported as not visible, whatever its variance.
  [[nodiscard]] const league::TrackedPacket& packet_of(const msg::WorldState& world);

 private:
  const Scenario scenario_;
  league::TrackedPacket packet_;
};

}  // namespace sidestep
