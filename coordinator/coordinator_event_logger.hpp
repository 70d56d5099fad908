// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>

#include "common/log/log_event.hpp"
#include "common/time/time.hpp"
#include "coordinator/ledger.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Reports changes of a coordinator's state: whether it grants, which robots have problems, which pairs are
/// in conflict, and whose registrations it awaits.
class CoordinatorEventLogger {
 public:
  /// If registration takes longer than this, the coordinator reports the missing robots, and again after each
  /// such interval.
  static constexpr Duration kRegistrationTime{1'000'000'000};

  explicit CoordinatorEventLogger(const EventReporter& events) : events_(events) {}

  /// Reports the changes since the last call.
  void update(const msg::CoordinatorState& state, std::span<const Conflict> conflicts, Time now);
  /// Forgets the last state, because a new epoch has begun or this coordinator has become a standby.
  void reset();

 private:
  using Robots = std::set<RobotId>;
  void report_granting(const msg::CoordinatorState& state, Time now);
  /// Reports the robots that have joined or left a set, and stores the set.
  void report_robots(Robots now, Robots& before, LogLevel level, const char* begun, const char* ended);
  void report_conflicts(std::span<const Conflict> conflicts);

  const EventReporter& events_;
  bool was_granting_ = false;
  std::optional<Time> registering_since_;
  Robots quarantined_, displaced_, silent_;
  std::set<Conflict> conflicts_;
};

}  // namespace sidestep
