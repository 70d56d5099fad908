// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/config/scenario.hpp"
#include "common/league/tracked_packet.hpp"
#include "idl/vision.h"

namespace sidestep {

/// Makes of worlds what others in the league read. Obstacles are left out: there is no word for them.
class TrackedOutput {
 public:
  /// The incarnation becomes the sender's unique name. Throws std::invalid_argument when two robots of the
  /// scenario have one team and number.
  TrackedOutput(const Scenario& scenario, Incarnation incarnation);

  /// Valid until the next call. A robot that was not seen for the last 100 ms is not visible, however well it
  /// is known where it is.
  const league::TrackedPacket& packet_of(const msg::WorldState& world);

 private:
  const Scenario scenario_;
  league::TrackedPacket packet_;
};

}  // namespace sidestep
