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

/// Reports what has changed in a coordinator: whether it grants, which robots are not in order, which pairs
/// are in conflict, and for whose registrations it waits.
class StateChanges {
 public:
  /// A coordinator that registers robots for longer names those that are missing, again after each such time.
  static constexpr Duration kRegistrationTime{1'000'000'000};

  explicit StateChanges(const EventReporter& events) : events_(events) {}

  /// Compares the state with the one of the last call.
  void update(const msg::CoordinatorState& state, std::span<const Conflict> conflicts, Time now);
  /// Forgets the last state: a new epoch has begun, or this coordinator stands by.
  void reset();

 private:
  using Robots = std::set<RobotId>;
  void report_granting(const msg::CoordinatorState& state, Time now);
  /// Reports the robots that are new in a set, and those that have left it, and stores the set.
  void report_robots(Robots now, Robots& before, LogLevel level, const char* begun, const char* ended);
  void report_conflicts(std::span<const Conflict> conflicts);

  const EventReporter& events_;
  bool was_granting_ = false;
  std::optional<Time> registering_since_;
  Robots quarantined_, displaced_, silent_;
  std::set<Conflict> conflicts_;
};

}  // namespace sidestep
