// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_event_logger.hpp"

#include <algorithm>
#include <fmt/ranges.h>
#include <utility>

#include "common/messaging/robot_notices.hpp"

namespace sidestep {
namespace {

std::set<RobotId> set_of(const std::vector<RobotId>& robots) { return {robots.begin(), robots.end()}; }

}  // namespace

void CoordinatorEventLogger::reset() {
  was_granting_ = false;
  registering_since_.reset();
  for (Robots* robots : {&quarantined_, &displaced_, &silent_}) robots->clear();
  conflicts_.clear();
}

void CoordinatorEventLogger::update(const msg::CoordinatorState& state, std::span<const Conflict> conflicts,
                                    Time now) {
  report_granting(state, now);
  report_robots(set_of(quarantined_robots(state)), quarantined_, LogLevel::kWarning,
                "is quarantined: nothing is granted to it", "is released from quarantine");
  report_robots(set_of(displaced_robots(state)), displaced_, LogLevel::kWarning,
                "is displaced: vision sees it where none of its versions leads",
                "is no longer displaced: vision sees it where its versions lead");
  report_robots(set_of(robots_where(state, [](const auto& notice) { return notice.is_silent(); })), silent_,
                LogLevel::kWarning, "is silent, although it should be in motion", "is heard again");
  report_conflicts(conflicts);
}

void CoordinatorEventLogger::report_granting(const msg::CoordinatorState& state, Time now) {
  const bool is_granting = state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_GRANTING;
  if (is_granting && !was_granting_)
    events_.report(LogLevel::kInfo, {}, "granting in epoch {}: no registration is missing", state.epoch());
  was_granting_ = is_granting;
  const bool is_registering = state.coordinator_mode() == msg::CoordinatorMode::COORDINATOR_REGISTERING;
  if (!is_registering) {
    registering_since_.reset();
  } else if (!registering_since_) {
    registering_since_ = now;
  } else if (now - *registering_since_ >= kRegistrationTime) {
    registering_since_ = now;
    events_.report(LogLevel::kWarning, {}, "waiting for robots {} to register",
                   fmt::join(missing_robots(state), ", "));
  }
}

void CoordinatorEventLogger::report_robots(Robots now, Robots& before, LogLevel level, const char* begun,
                                           const char* ended) {
  for (const RobotId robot : now) {
    if (!before.contains(robot)) events_.report(level, robot, "robot {} {}", robot, begun);
  }
  for (const RobotId robot : before) {
    if (!now.contains(robot)) events_.report(LogLevel::kInfo, robot, "robot {} {}", robot, ended);
  }
  before = std::move(now);
}

void CoordinatorEventLogger::report_conflicts(std::span<const Conflict> conflicts) {
  if (conflicts.empty() && conflicts_.empty()) return;
  const std::set<Conflict> now(conflicts.begin(), conflicts.end());
  for (const Conflict& pair : now) {
    if (!conflicts_.contains(pair))
      events_.report(LogLevel::kWarning, pair.first, "robots {} and {} are in conflict", pair.first,
                     pair.second);
  }
  for (const Conflict& pair : conflicts_) {
    if (!now.contains(pair))
      events_.report(LogLevel::kInfo, pair.first, "robots {} and {} are no longer in conflict", pair.first,
                     pair.second);
  }
  conflicts_ = now;
}

}  // namespace sidestep
