// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/robot_records.hpp"

#include <algorithm>

namespace sidestep {

RobotRecords::RobotRecords(const AuditedRun& run, AuditFindings& findings)
    : run_(run), findings_(findings), index_(kMaxRobots, run.scenario.robots.size()) {
  for (const RobotSpec& spec : run.scenario.robots) {
    index_.at(spec.id) = robots_.size();
    robots_.emplace_back().id = spec.id;
  }
}

KnownVersion* RobotRecords::store(AuditedRobot& robot, const msg::Version& version) {
  if (version.robot() != robot.id || !is_sane(version)) {
    ++findings_.totals.invalid;
    return nullptr;
  }
  KnownVersion& known = robot.find_or_insert(version.version_number());
  // A later agent, or a simulator of another floor, reuses the number. An auditor that received every message
  // would have forgotten the old version by now.
  const bool is_another = known.has_content && (known.version.incarnation() != version.incarnation() ||
                                                (known.number == 0 && !(known.version == version)));
  if (!run_.is_complete() && is_another) {
    known = KnownVersion();
    known.number = version.version_number();
  }
  if (!known.has_content) {
    known.has_content = true;
    known.version = version;
    known.path = AuditPath(version);
    known.is_content_checked = known.is_pair_checked = run_.is_complete();
    max_inflation_m_ = std::max(max_inflation_m_, version.inflation_m());
    // An earlier report may exclude the version.
    if (robot.last_report) known.exclusion = exclusion_by(*robot.last_report, known);
    known.excluded_ns = known.exclusion == Exclusion::kNone ? kNever : to_ns(findings_.now);
    robot.make_recent(known.number);
  } else if (!(known.version == version)) {
    findings_.report(AuditRule::kUniqueVersion, robot.id, &known, 0,
                     "one message has a start at {} ns and ({:.6f}, {:.6f}) m, another one at {} ns and "
                     "({:.6f}, {:.6f}) m",
                     known.version.start_ns(), known.version.x_m(), known.version.y_m(), version.start_ns(),
                     version.x_m(), version.y_m());
  }
  return &known;
}

const KnownVersion* RobotRecords::base_of(const AuditedRobot& robot, const KnownVersion& known) const {
  const KnownVersion* base = robot.find(known.version.base());
  if (!base || !base->has_content) return nullptr;
  const bool is_certain =
      run_.is_complete() || base->was_executed || base->version.incarnation() == known.version.incarnation();
  return is_certain ? base : nullptr;
}

}  // namespace sidestep
