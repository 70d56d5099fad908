// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.hpp"

#include <algorithm>

#include "common/motion/clearance.hpp"
#include "common/motion/outline.hpp"

namespace sidestep {

Ledger::Ledger(const FloorRules& rules, std::vector<RobotId> roster)
    : rules_(rules),
      roster_(std::move(roster)),
      index_(kMaxRobots, roster_.size()),
      entries_(roster_.size()),
      places_(rules.field, roster_.size()) {
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
  bound(index_of(robot));
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
  bound(index_of(candidate.robot));
  return {};
}

bool Ledger::forget(RobotId robot, VersionNumber executing, Time at) {
  Entry& entry = entries_[index_of(robot)];
  if (!entry.set.forget(executing, at)) return false;
  bound(index_of(robot));
  return true;
}

void Ledger::clear() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    entries_[i].set.clear();
    bound(i);
  }
}

void Ledger::bound(std::size_t index) {
  Entry& entry = entries_[index];
  const auto versions = entry.set.versions();
  if (versions.empty()) {
    places_.remove(static_cast<std::uint32_t>(index));
    return;
  }
  for (std::size_t i = 0; i < versions.size(); ++i) entry.discs[i] = disc_of(versions[i].trajectory);
  Circle all = entry.discs.front();
  for (std::size_t i = 1; i < versions.size(); ++i) {
    const double offset = (entry.discs[i].centre_m - all.centre_m).norm();
    all.radius_m = std::max(all.radius_m, offset + entry.discs[i].radius_m);
  }
  places_.set(static_cast<std::uint32_t>(index), all);
}

std::optional<RobotId> Ledger::blocker_of(const Trajectory& trajectory, RobotId robot) {
  const double keep = rules_.keep_m();
  Circle around = disc_of(trajectory);
  around.radius_m += keep + kClearanceTolerance_m;
  places_.find(around, near_);
  for (const std::uint32_t index : near_) {
    if (roster_[index] == robot) continue;
    const auto versions = entries_[index].set.versions();
    for (std::size_t i = 0; i < versions.size(); ++i) {
      if (touch(entries_[index].discs[i], around) && !is_clear(trajectory, versions[i].trajectory, keep))
        return roster_[index];
    }
  }
  return std::nullopt;
}

}  // namespace sidestep
