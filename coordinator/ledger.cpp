// SPDX-License-Identifier: Apache-2.0
#include "coordinator/ledger.hpp"

#include <algorithm>
#include <limits>

#include "common/motion/clearance.hpp"
#include "common/motion/escape.hpp"
#include "common/motion/rest.hpp"
#include "common/motion/trajectory_bounds.hpp"

namespace sidestep {
namespace {

bool is_rest_version(const Version& version) {
  return version.base == 0 && version.trajectory.phases().empty() &&
         version.trajectory.residual_speed_mps() == 0;
}

/// A version must have its base's inflation, or 0 if it begins at rest.
bool is_inflation_allowed(const Version& candidate, const Version& base) {
  if (candidate.inflation_m == base.inflation_m) return true;
  return candidate.inflation_m == 0 &&
         candidate.trajectory.at_start().velocity_mps.norm() <= kPlannedRest_mps;
}

/// Whether two versions with equal numbers have equal contents.
bool is_same(const Version& a, const Version& b) {
  const State &from = a.trajectory.at_start(), &other = b.trajectory.at_start();
  return a.base == b.base && a.trajectory.start() == b.trajectory.start() &&
         from.position_m == other.position_m && from.velocity_mps == other.velocity_mps &&
         a.inflation_m == b.inflation_m &&
         std::ranges::equal(a.trajectory.phases(), b.trajectory.phases(),
                            [](const MotionPhase& p, const MotionPhase& q) {
                              return p.duration == q.duration && p.acceleration_mps2 == q.acceleration_mps2;
                            });
}

msg::Reason reason_of(Validity validity) {
  switch (validity) {
    case Validity::kValid:
      return msg::Reason::REASON_GRANTED;
    case Validity::kBeyondLimits:
      return msg::Reason::REASON_BEYOND_LIMITS;
    case Validity::kNotAtRest:
      return msg::Reason::REASON_NOT_AT_REST;
    case Validity::kOutsideField:
      return msg::Reason::REASON_OUTSIDE_FIELD;
    case Validity::kObstacle:
      return msg::Reason::REASON_OBSTACLE;
  }
  return msg::Reason::REASON_MALFORMED;
}

}  // namespace

Ledger::Ledger(const FloorRules& rules, std::vector<RobotId> roster, Duration max_clock_difference)
    : rules_(rules),
      max_clock_difference_(max_clock_difference),
      roster_(std::move(roster)),
      index_(kMaxRobots, roster_.size()),
      entries_(roster_.size()),
      grid_(rules.field, roster_.size()) {
  std::sort(roster_.begin(), roster_.end());
  for (std::size_t i = 0; i < roster_.size(); ++i) index_.at(roster_[i]) = i;
}

std::size_t Ledger::index_of(RobotId robot) const {
  return robot < kMaxRobots ? index_[robot] : roster_.size();
}

std::span<const Version> Ledger::versions(RobotId robot) const {
  return has_robot(robot) ? entries_[index_of(robot)].versions() : std::span<const Version>{};
}

bool Ledger::is_quarantined(RobotId robot) const {
  return has_robot(robot) && !entries_[index_of(robot)].quarantined.empty();
}

bool Ledger::lists_reported(RobotId robot, std::span<const Version> versions) const {
  const Version& reported = entries_[index_of(robot)].quarantined.back();
  return std::ranges::any_of(
      versions, [&](const Version& v) { return v.number == reported.number && is_same(v, reported); });
}

void Ledger::Entry::quarantine(const Version& reported) {
  quarantined.assign(set.versions().begin(), set.versions().end());
  quarantined.push_back(reported);
  agreeing = 0;
}

bool Ledger::Entry::record_agreement() {
  if (quarantined.empty()) return true;
  if (++agreeing < kReportsUntilReleased) return false;
  release();
  return true;
}

void Ledger::register_robot(RobotId robot, std::span<const Version> versions) {
  Entry& entry = entry_of(robot);
  entry.set.clear();
  entry.quarantined.clear();
  for (const Version& version : versions) entry.set.add(version);
  update_bounds(index_of(robot));
  find_conflicts(robot);
}

Ruling Ledger::grant(const Version& candidate) {
  Entry& entry = entry_of(candidate.robot);
  const Version* base = entry.set.find(candidate.base);
  const bool is_absent = entry.set.versions().empty();
  if (is_absent && !is_rest_version(candidate)) return {msg::Reason::REASON_ABSENT};
  if (!is_absent && !base) return {msg::Reason::REASON_BASE_UNKNOWN};
  if (entry.set.is_full()) return {msg::Reason::REASON_LEDGER_FULL};
  if (const auto refusal = refusal_reason(candidate, base); refusal != msg::Reason::REASON_GRANTED)
    return {refusal};
  if (const auto blocker = find_blocker(candidate, base)) return {msg::Reason::REASON_CONFLICT, *blocker};
  entry.set.add(candidate);
  update_bounds(index_of(candidate.robot));
  return {};
}

msg::Reason Ledger::refusal_reason(const Version& candidate, const Version* base) const {
  const Trajectory& trajectory = candidate.trajectory;
  if (!base) {
    return candidate.inflation_m == 0 ? reason_of(check_workspace(trajectory, rules_))
                                      : msg::Reason::REASON_NOT_CONTINUOUS;
  }
  if (candidate.number <= base->number) return msg::Reason::REASON_OLD_VERSION;
  if (!continues(trajectory, base->trajectory) || !is_inflation_allowed(candidate, *base))
    return msg::Reason::REASON_NOT_CONTINUOUS;
  if (const auto validity = check_limits(trajectory, rules_.limits); validity != Validity::kValid)
    return reason_of(validity);
  return reason_of(check_workspace_with_escape(candidate, base->trajectory, rules_));
}

ReportOutcome Ledger::judge(const Version& executing, Time at, bool is_off_reference,
                            Incarnation robot_incarnation) const {
  const Entry& entry = entries_[index_of(executing.robot)];
  if (robot_incarnation == entry.lifted_incarnation && at <= entry.lifted_at) return ReportOutcome::kStale;
  const auto is_older = [&](const Version& held) { return held.number < executing.number; };
  const auto versions = entry.set.versions();
  if (const Version* held = entry.set.find(executing.number))
    return is_same(*held, executing) ? ReportOutcome::kApplied : ReportOutcome::kContradiction;
  if (!versions.empty() && std::ranges::none_of(versions, is_older)) return ReportOutcome::kStale;
  const bool is_own_stop = is_off_reference && std::ranges::all_of(versions, is_older);
  return is_own_stop ? ReportOutcome::kApplied : ReportOutcome::kContradiction;
}

ReportOutcome Ledger::on_executing(const Version& executing, Time at, bool is_off_reference,
                                   Incarnation robot_incarnation) {
  const ReportOutcome outcome = judge(executing, at, is_off_reference, robot_incarnation);
  if (outcome == ReportOutcome::kStale) return outcome;
  Entry& entry = entry_of(executing.robot);
  if (outcome == ReportOutcome::kContradiction) {
    entry.quarantine(executing);
    update_bounds(index_of(executing.robot));
    find_conflicts(executing.robot);
    return outcome;
  }
  const bool is_own_stop = !entry.set.find(executing.number);
  if (!entry.record_agreement()) {
    if (is_own_stop) {
      entry.quarantined.back() = executing;
      update_bounds(index_of(executing.robot));
      find_conflicts(executing.robot);
    }
    return ReportOutcome::kApplied;
  }
  const auto store_former = [&](const Version& version) { entry.former.add(version, at); };
  if (is_own_stop) {
    std::ranges::for_each(entry.set.versions(), store_former);
    entry.set.clear();
    entry.set.add(executing);
  } else {
    entry.set.forget(executing.number, at, store_former);
  }
  update_bounds(index_of(executing.robot));
  if (is_own_stop)
    find_conflicts(executing.robot);
  else
    end_conflicts(executing.robot);
  return ReportOutcome::kApplied;
}

void Ledger::on_lifted(RobotId robot, Time at, Incarnation robot_incarnation) {
  Entry& entry = entry_of(robot);
  entry.lifted_at = robot_incarnation == entry.lifted_incarnation ? std::max(entry.lifted_at, at) : at;
  entry.lifted_incarnation = robot_incarnation;
  entry.set.forget_started(at, [&](const Version& version) { entry.former.add(version, at); });
  if (!entry.quarantined.empty()) {
    const Version reported = entry.quarantined.back();
    entry.quarantined.clear();
    if (reported.trajectory.start() > at) entry.quarantine(reported);
  }
  update_bounds(index_of(robot));
  end_conflicts(robot);
}

std::optional<double> Ledger::distance_from_versions_m(RobotId robot, const Vec2& position_m, Time at) const {
  if (!has_robot(robot)) return std::nullopt;
  const Entry& entry = entries_[index_of(robot)];
  std::optional<double> least;
  const auto compare = [&](const Version& version) {
    if (version.trajectory.start() > at + max_clock_difference_) return;
    const Vec2 reference_m = version.trajectory.state_at(at).position_m;
    const double distance = (position_m - reference_m).norm() - version.inflation_m;
    least = std::min(least.value_or(distance), distance);
  };
  for (const Version& version : entry.versions()) compare(version);
  for (const FormerVersions::Entry& former : entry.former.entries()) {
    if (former.left_at >= at - max_clock_difference_) compare(former.version);
  }
  if (!least && entry.versions().empty() && at > entry.lifted_at + max_clock_difference_)
    return std::numeric_limits<double>::infinity();
  return least;
}

bool Ledger::rests_since(RobotId robot, Time since) const {
  if (!has_robot(robot)) return false;
  const Entry& entry = entries_[index_of(robot)];
  const auto had_ended = [&](const Version& version) {
    return version.trajectory.end() + max_clock_difference_ <= since;
  };
  const auto was_left_or_had_ended = [&](const FormerVersions::Entry& former) {
    return former.left_at + max_clock_difference_ <= since || had_ended(former.version);
  };
  return !entry.versions().empty() && std::ranges::all_of(entry.versions(), had_ended) &&
         std::ranges::all_of(entry.former.entries(), was_left_or_had_ended);
}

void Ledger::clear() {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    entries_[i] = {};
    update_bounds(i);
  }
  conflicts_.clear();
}

void Ledger::update_bounds(std::size_t index) {
  Entry& entry = entries_[index];
  const auto versions = entry.versions();
  if (versions.empty()) {
    grid_.remove(static_cast<std::uint32_t>(index));
    return;
  }
  for (std::size_t i = 0; i < versions.size(); ++i) {
    entry.discs[i] = disc_of(versions[i].trajectory);
    entry.discs[i].radius_m += versions[i].inflation_m;
  }
  Circle all = entry.discs.front();
  for (std::size_t i = 1; i < versions.size(); ++i) {
    const double offset = (entry.discs[i].centre_m - all.centre_m).norm();
    all.radius_m = std::max(all.radius_m, offset + entry.discs[i].radius_m);
  }
  grid_.set(static_cast<std::uint32_t>(index), all);
}

bool Ledger::are_compatible(const Version& candidate, const Version* base, const Version& other) const {
  const double separation = rules_.min_separation_m() + candidate.inflation_m + other.inflation_m;
  if (is_clear(candidate.trajectory, other.trajectory, separation)) return true;
  if (!base) return false;
  const double relaxed =
      relaxed_separation_m(base->trajectory, candidate.trajectory.start(), other.trajectory, separation);
  return relaxed < separation && is_clear(candidate.trajectory, other.trajectory, relaxed);
}

std::optional<RobotId> Ledger::find_blocker(const Version& candidate, const Version* base) {
  Circle search_disc = disc_of(candidate.trajectory);
  search_disc.radius_m += candidate.inflation_m + rules_.min_separation_m() + kClearanceTolerance_m;
  grid_.find(search_disc, nearby_);
  for (const std::uint32_t index : nearby_) {
    if (roster_[index] == candidate.robot) continue;
    const auto versions = entries_[index].versions();
    for (std::size_t i = 0; i < versions.size(); ++i) {
      if (touch(entries_[index].discs[i], search_disc) && !are_compatible(candidate, base, versions[i]))
        return roster_[index];
    }
  }
  return std::nullopt;
}

bool Ledger::are_in_conflict(const Entry& a, const Entry& b) const {
  return std::ranges::any_of(a.versions(), [&](const Version& v) {
    return std::ranges::any_of(b.versions(),
                               [&](const Version& w) { return !are_compatible(v, nullptr, w); });
  });
}

void Ledger::find_conflicts(RobotId robot) {
  std::erase_if(conflicts_, [=](const Conflict& c) { return c.first == robot || c.second == robot; });
  const Entry& entry = entry_of(robot);
  for (std::size_t i = 0; i < entry.versions().size(); ++i) {
    Circle search_disc = entry.discs[i];
    search_disc.radius_m += rules_.min_separation_m() + kClearanceTolerance_m;
    grid_.find(search_disc, nearby_);
    for (const std::uint32_t index : nearby_) {
      const Conflict pair{std::min(robot, roster_[index]), std::max(robot, roster_[index])};
      if (roster_[index] == robot || std::ranges::count(conflicts_, pair) > 0) continue;
      if (are_in_conflict(entry, entries_[index])) conflicts_.push_back(pair);
    }
  }
}

void Ledger::end_conflicts(RobotId robot) {
  std::erase_if(conflicts_, [&](const Conflict& c) {
    return (c.first == robot || c.second == robot) && !are_in_conflict(entry_of(c.first), entry_of(c.second));
  });
}

}  // namespace sidestep
