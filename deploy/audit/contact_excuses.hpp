// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "deploy/audit/audit_shape.hpp"
#include "deploy/audit/position_audit.hpp"

namespace sidestep {

/// Decides whether a contact that the reference shows is excused, or may be excused by a missed message.
class ContactExcuses {
 public:
  ContactExcuses(const AuditedRun& run, const RobotRecords& robots, const RunCoverage& coverage,
                 const PositionAudit& positions, Disturbances& disturbances, AuditFindings& findings);

  /// From now on, each robot counts as off the floor until it is observed.
  void begin_observation() { observed_.assign(observed_.size(), std::nullopt); }
  /// Records a robot on the floor. `error_m` is the distance from the place that its version prescribes; up
  /// to `allowance_m` of it may be an observation error.
  void observe(const AuditedRobot& robot, const Vec2& position_m, double speed_mps, double error_m,
               double allowance_m);
  /// Call after observe() for all robots that are on the floor at this time.
  void end_observation(Time at) { disturbances_.update(at, observed_); }
  /// Records contacts of unknown robots: from now on, it is unknown which robots pushed which others.
  void on_unknown_contacts() { are_contacts_unknown_ = true; }

  /// Returns whether a contact is excused or undecided, and counts it in that case. `second`: nullopt means
  /// an obstacle. `apart_ns` is the last time at which vision saw the pair apart.
  bool excuses(RobotId first, std::optional<RobotId> second, Time at, std::int64_t apart_ns = kAlways);
  /// Whether everything that may excuse a contact of this robot was received.
  bool are_known(std::optional<std::size_t> robot, std::int64_t apart_ns = kAlways) const;

  void add_to(AuditTotals& totals) const;

 private:
  double distance_from_obstacles_m(const Vec2& position_m) const;

  const AuditedRun& run_;
  const RobotRecords& robots_;
  const RunCoverage& coverage_;
  const PositionAudit& positions_;
  Disturbances& disturbances_;
  AuditFindings& findings_;
  std::vector<AuditShape> obstacles_;
  std::vector<std::optional<ObservedRobot>>
      observed_;  ///< last observed on the floor; parallel to the robots
  bool are_contacts_unknown_ = false;
  /// Number of excused contacts, by cause and robots.
  std::map<std::tuple<std::string_view, RobotId, std::optional<RobotId>>, std::uint64_t> excused_;
};

}  // namespace sidestep
