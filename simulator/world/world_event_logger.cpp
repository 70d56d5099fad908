// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/world_event_logger.hpp"

#include <algorithm>

#include "common/messaging/disturbance_answer.hpp"
#include "common/protocol/disturbance_text.hpp"
#include "common/robot/own_stop_text.hpp"

namespace sidestep {

WorldEventLogger::WorldEventLogger(const EventReporter& events, const World& world)
    : events_(events), world_(world), own_stops_(world.robot_count()) {}

void WorldEventLogger::update() {
  for (std::size_t i = 0; i < own_stops_.size(); ++i) {
    const Firmware& firmware = world_.firmware(i);
    if (!firmware.is_off_reference() || firmware.executing().number <= own_stops_[i]) continue;
    own_stops_[i] = firmware.executing().number;
    events_.report(LogLevel::kWarning, world_.id(i), "robot {} makes its own stop: {}", world_.id(i),
                   to_text(firmware.own_stop_reason()));
  }
  const ContactTotals& totals = world_.contacts();
  if (totals.contacts == contacts_) return;
  const std::uint64_t first =
      std::max(contacts_, totals.contacts - std::min<std::uint64_t>(totals.contacts, msg::MAX_CONTACTS));
  for (std::uint64_t k = first; k < totals.contacts; ++k)
    report_contact(totals.recent_contacts[k % totals.recent_contacts.size()]);
  contacts_ = totals.contacts;
}

void WorldEventLogger::report_contact(const ContactPair& pair) const {
  const RobotId robot = world_.id(pair.first);
  if (pair.second < world_.robot_count())
    events_.report(LogLevel::kWarning, robot, "robots {} and {} touch", robot, world_.id(pair.second));
  else
    events_.report(LogLevel::kWarning, robot, "robot {} touches an obstacle", robot);
}

void WorldEventLogger::on_disturbance(const RobotDisturbance& disturbance) const {
  events_.report(LogLevel::kInfo, disturbance.robot, "disturbance of robot {}: {}", disturbance.robot,
                 to_text(disturbance.kind));
}

void WorldEventLogger::on_refused_disturbance(RobotId robot, msg::DisturbanceResult result) const {
  events_.report(LogLevel::kWarning, robot, "refused a disturbance of robot {}: {}", robot,
                 refusal_text(robot, result));
}

}  // namespace sidestep
