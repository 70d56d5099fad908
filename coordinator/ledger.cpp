// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"

namespace sidestep {

Ledger::Ledger(const FloorRules& rules, std::vector<RobotId> roster)
    : rules_(rules),
      roster_(std::move(roster)),
      index_(kMaxRobots, roster_.size()),
      entries_(roster_.size()) {
  std::sort(roster_.begin(), roster_.end());
  for (std::size_t i = 0; i < roster_.size(); ++i) index_.at(roster_[i]) = i;
}

std::size_t Ledger::index_of(RobotId robot) const {
  return robot < kMaxRobots ? index_[robot] : roster_.size();
}

std::span<const Version> Ledger::versions(RobotId robot) const {
  return knows(robot) ? entries_[index_of(robot)].set.versions() : std::span<const Version>{};
}

std::optional<RobotId> Ledger::enter(RobotId robot, std::span<const Version> versions) {
  Entry& entry = entries_[index_of(robot)];
  std::optional<RobotId> blocker;
  for (const Version& version : versions) {
    if (!blocker) blocker = blocker_of(version.trajectory, robot);
    entry.set.add(version);
  }
  bound(entry);
  return blocker;
}

Ruling Ledger::grant(const Version& candidate) {
  Entry& entry = entries_[index_of(candidate.robot)];
  const Version* base = entry.set.find(candidate.base);
  if (!base) return {msg::REASON_BASE_UNKNOWN};
  if (candidate.number <= base->number) return {msg::REASON_OLD_VERSION};
  if (entry.set.is_full()) return {msg::REASON_LEDGER_FULL};
  const Trajectory& trajectory = candidate.trajectory;
  if (!continues(trajectory, base->trajectory)) return {msg::REASON_NOT_CONTINUOUS};
  if (const auto reason = check_limits(trajectory, rules_.limits); reason != msg::REASON_GRANTED)
    return {reason};
  if (const auto reason = check_place(trajectory, rules_); reason != msg::REASON_GRANTED) return {reason};
  if (const auto blocker = blocker_of(trajectory, candidate.robot)) return {msg::REASON_CONFLICT, *blocker};
  entry.set.add(candidate);
  bound(entry);
  return {};
}

bool Ledger::forget(RobotId robot, VersionNumber executing, Time at) {
  Entry& entry = entries_[index_of(robot)];
  if (!entry.set.forget(executing, at)) return false;
  bound(entry);
  return true;
}

void Ledger::clear() {
  for (Entry& entry : entries_) entry = {};
}

void Ledger::bound(Entry& entry) const {
  const auto versions = entry.set.versions();
  if (versions.empty()) return;
  entry.centre_m = versions.front().trajectory.at_start().position_m;
  entry.reach_m = 0;
  for (const Version& version : versions) {
    const double offset = (version.trajectory.at_start().position_m - entry.centre_m).norm();
    entry.reach_m = std::max(entry.reach_m, offset + reach_m(version.trajectory));
  }
}

std::optional<RobotId> Ledger::blocker_of(const Trajectory& trajectory, RobotId robot) const {
  const double keep = rules_.keep_m();
  const double reach = reach_m(trajectory) + keep + kClearanceTolerance_m;
  for (std::size_t i = 0; i < roster_.size(); ++i) {
    const Entry& other = entries_[i];
    const double far = reach + other.reach_m;
    if (roster_[i] == robot || (other.centre_m - trajectory.at_start().position_m).squaredNorm() > far * far)
      continue;
    for (const Version& version : other.set.versions()) {
      if (!is_clear(trajectory, version.trajectory, keep)) return roster_[i];
    }
  }
  return std::nullopt;
}

}  // namespace sidestep
