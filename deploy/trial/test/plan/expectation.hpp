// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/motion/version.hpp"

namespace sidestep {

/// The problem for which a robot is named: by the coordinator, or by its own agent (kClockOutOfBound).
enum class NoticeKind { kMissing, kQuarantined, kDisplaced, kConflict, kClockOutOfBound };
/// The name used in scenario files, for example "missing".
[[nodiscard]] const char* name_of(NoticeKind kind);
[[nodiscard]] std::optional<NoticeKind> notice_kind_named(const std::string& name);

/// A set of robots of a scenario.
struct RobotSet {
  std::vector<RobotId> ids;
  bool is_all = false;

  bool contains(RobotId robot) const;
};
/// For example "all robots" or "robot 3".
[[nodiscard]] std::string to_text(const RobotSet& robots);

/// Part of a run, in seconds since the first grant.
struct TimeSpan {
  double from_s = 0, to_s = 0;
};

/// None of these robots touches another robot or an obstacle. Contacts with the excepted robots do not count.
/// If the set is all robots, none of them touches an opponent while moving.
struct ExpectNoContact {
  RobotSet robots, except;
};
/// The audit covers enough of the run and finds no violations.
struct ExpectNoViolations {};
struct ExpectArrived {
  RobotSet robots;
  std::optional<double> by_s;  ///< nullopt: the end of the run
};
/// These robots have not arrived at the end of the run.
struct ExpectNotArrived {
  RobotSet robots;
};
/// Each robot comes to rest within the span, and then stays at rest for a while.
struct ExpectAtRest {
  RobotSet robots;
  TimeSpan span;
  double for_s = 0;
};
/// Each robot moves within the span.
struct ExpectMoving {
  RobotSet robots;
  TimeSpan span;
};
struct ExpectMinClearance {
  double clearance_m = 0;
};
struct ExpectMaxSpeed {
  RobotSet robots;
  double speed_mps = 0;
  double from_s = 0;
  std::optional<double> to_s;  ///< nullopt: the end of the run
};
/// Within the span, a different coordinator begins to grant, in a higher epoch.
struct ExpectTakeover {
  TimeSpan span;
};
/// Each robot is named for this problem within the span.
struct ExpectNamed {
  RobotSet robots;
  NoticeKind as = NoticeKind::kMissing;
  TimeSpan span;
};
/// The report names a process whose rules differ.
struct ExpectMismatch {
  std::string process;
};

using ExpectationCheck = std::variant<ExpectNoContact, ExpectNoViolations, ExpectArrived, ExpectNotArrived,
                                      ExpectAtRest, ExpectMoving, ExpectMinClearance, ExpectMaxSpeed,
                                      ExpectTakeover, ExpectNamed, ExpectMismatch>;

/// A condition that a run of a test must meet.
struct Expectation {
  ExpectationCheck check;
  int line = 0;  ///< line in the test's file
};

/// One line without a verdict, for example "robot 3 at rest between 1 s and 1.5 s".
[[nodiscard]] std::string describe(const Expectation& expectation);
/// The latest time at which the expectation is decided; nullopt: the end of the run.
[[nodiscard]] std::optional<double> deadline_s(const Expectation& expectation);

}  // namespace sidestep
