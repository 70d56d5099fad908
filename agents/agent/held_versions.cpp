// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/held_versions.hpp"

#include <algorithm>

namespace sidestep {

void HeldVersions::begin(const RobotReport& robot_report) {
  versions_.clear();
  if (!robot_report.is_absent()) versions_.add(robot_report.executing);
  executing_ = robot_report.executing.number;
  latest_report_ = robot_report.valid_at;
  next_number_ = std::max(next_number_, robot_report.obeyed_incarnation);
  continue_numbers_after(robot_report.executing);
}

// A robot off the floor reports its last version as the base, because the stop that it made before it was
// lifted may never have been reported.
void HeldVersions::continue_numbers_after(const Version& executing) {
  next_number_ = std::max({next_number_, executing.number + 1, executing.base + 1});
}

HeldVersions::ReportEffect HeldVersions::apply(const RobotReport& robot_report, bool is_current) {
  const Version& executing = robot_report.executing;
  const Time at = robot_report.valid_at;
  const std::size_t before = versions_.versions().size();
  const bool has_advanced = executing.number != executing_;
  ReportEffect effect;
  if (robot_report.is_absent()) {
    effect.is_late = !is_current || at < latest_report_;
    if (effect.is_late) return effect;
    versions_.forget_started(at);
    executing_ = 0;
    continue_numbers_after(executing);
  } else if (versions_.forget(executing.number, at)) {
    executing_ = executing.number;
    effect.has_switched = has_advanced;
  } else {
    // A later report about an older version proves that an earlier report was false: robots never return to
    // older versions.
    const auto is_older = [&](const Version& held) { return held.number < executing.number; };
    effect.is_late =
        !std::ranges::any_of(versions_.versions(), is_older) && (!is_current || at <= latest_report_);
    if (effect.is_late) return effect;
    effect.is_unknown = true;
    versions_.clear();
    versions_.add(executing);
    executing_ = executing.number;
    continue_numbers_after(executing);
  }
  if (is_current) latest_report_ = std::max(latest_report_, at);
  // If the robot has advanced, one removed version is the one that it executed before. All other removed
  // versions were lost: the robot can no longer switch to them.
  const int gone = static_cast<int>(before) - static_cast<int>(versions_.versions().size());
  if (!effect.is_unknown) effect.lost = std::max(0, gone - (has_advanced ? 1 : 0));
  return effect;
}

const Version& HeldVersions::base_at(Time start) const {
  const Version* current = &executing();
  const auto follows = [&](const Version& next) {
    return next.base == current->number && next.number != current->number && next.trajectory.start() < start;
  };
  for (;;) {
    const auto next = std::ranges::find_if(versions_.versions(), follows);
    if (next == versions_.versions().end()) return *current;
    current = &*next;
  }
}

Time HeldVersions::last_start(Time now) const {
  if (is_executing()) return base_at(now + kMaxAhead).trajectory.start();
  Time last = Time::min();
  for (const Version& version : versions_.versions())
    if (version.trajectory.start() <= now + kMaxAhead) last = std::max(last, version.trajectory.start());
  return last;
}

bool HeldVersions::has_base(VersionNumber base) const {
  return versions_.find(base) || (!is_executing() && base == 0);
}

bool HeldVersions::has_unreachable() const {
  return std::ranges::any_of(versions_.versions(), [this](const Version& version) {
    return version.number != executing_ && !has_base(version.base);
  });
}

}  // namespace sidestep
