// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/log/log_event.hpp"
#include "simulator/world/world.hpp"

namespace sidestep {

/// Reports events of a simulated world's robots: disturbances, own stops and contacts.
class WorldEventLogger {
 public:
  WorldEventLogger(const EventReporter& events, const World& world);

  /// Reports own stops and contacts since the last call.
  void update();
  /// Reports that a disturbance has been applied.
  void on_disturbance(const RobotDisturbance& disturbance) const;
  void on_refused_disturbance(RobotId robot, msg::DisturbanceResult result) const;

 private:
  void report_contact(const ContactPair& pair) const;

  const EventReporter& events_;
  const World& world_;
  std::vector<VersionNumber> own_stops_;  // the last own stop of each robot
  std::uint64_t contacts_ = 0;
};

}  // namespace sidestep
