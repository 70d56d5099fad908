// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deploy/trial/test/plan/expectation.hpp"

namespace sidestep {

// The data by which expectations are judged. Times are in seconds since the first grant.

struct TrueSpeed {
  RobotId robot = 0;
  double speed_mps = 0;
};

/// The ground truth of the floor at one moment. Robots that are off the floor are omitted.
struct TruthSample {
  double at_s = 0;
  std::vector<TrueSpeed> robots;           ///< sorted by id
  double min_clearance_m = 0;              ///< smallest clearance since the start of the run
  std::uint64_t crashes_while_moving = 0;  ///< number of crashes since the start of the run

  std::optional<double> speed_of(RobotId robot) const;
};

/// A contact in ground truth.
struct ContactSample {
  double at_s = 0;
  RobotId first = 0;
  std::optional<RobotId> second;  ///< nullopt: an obstacle
};

/// A heartbeat of an active coordinator.
struct CoordinatorSample {
  double at_s = 0;
  int number = 0;
  std::uint64_t epoch = 0;
  bool is_granting = false;
};

struct NoticeSample {
  double at_s = 0;
  RobotId robot = 0;
  NoticeKind kind = NoticeKind::kMissing;
};

/// The facts known at the end of a run.
struct RunEnd {
  double at_s = 0;
  std::string abort_reason;  ///< empty: the run was not aborted
  std::map<RobotId, std::optional<double>> arrival_s;
  std::uint64_t violations = 0;
  double first_violation_at_s = 0;
  std::string first_violation;  ///< the first violation as one line
  std::string shortfall;        ///< why the audit covered too little; empty: it covered enough
  std::map<std::string, std::string> mismatches;  ///< processes with different rules, and the differences
};

/// Everything that was received about a run. Each list is sorted by time.
struct RunHistory {
  std::vector<TruthSample> truths;
  std::vector<ContactSample> contacts;
  /// Number of contacts for which ground truth did not name the robots.
  std::uint64_t unidentified_contacts = 0;
  std::vector<CoordinatorSample> coordinators;
  std::vector<NoticeSample> notices;
  RunEnd end;

  /// The number of the last coordinator that reported that it grants.
  std::optional<int> granting_coordinator() const;
  /// Whether the last heartbeat names the robot as missing.
  bool is_missing(RobotId robot) const;
};

}  // namespace sidestep
