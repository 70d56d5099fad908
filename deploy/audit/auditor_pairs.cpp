// SPDX-License-Identifier: Apache-2.0
// Clearance checks between the versions of two robots.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/audit/auditor.hpp"

namespace sidestep {
namespace {

std::int64_t entry_ns(const KnownVersion& known, Epoch epoch) {
  return known.granted_in == epoch ? known.granted_by_ns : kAlways;
}

}  // namespace

Auditor::Evidence Auditor::evidence_of(const KnownVersion& known) {
  return {known.alive_until_ns, known.executed_until_ns, known.was_executed};
}

double Auditor::min_separation_m(const KnownVersion& a, const KnownVersion& b) const {
  return 2 * scenario_.radius_m + scenario_.margin_m + a.version.inflation_m() + b.version.inflation_m();
}

std::optional<Epoch> Auditor::common_epoch(const KnownVersion& a, const Evidence& a_state,
                                           const KnownVersion& b, const Evidence& b_state) const {
  // Proof by a ledger: when both versions had been granted, in whichever order, no fact had excluded either
  // of them.
  for (const KnownVersion* granted : {&a, &b}) {
    const Epoch epoch = granted->granted_in;
    if (epoch == 0 || granted->is_own_stop || !was_checked_against(*granted, granted == &a ? b : a)) continue;
    const std::int64_t both_ns = std::max(entry_ns(a, epoch), entry_ns(b, epoch));
    if (std::min(a_state.alive_until_ns, b_state.alive_until_ns) >= both_ns) return epoch;
  }
  // Proof by facts: both were executed at one time, independently of any ledger.
  if (a.is_own_stop || b.is_own_stop || !a_state.was_executed || !b_state.was_executed) return std::nullopt;
  const std::int64_t from_ns = std::max(a.path.start_ns(), b.path.start_ns());
  const std::int64_t to_ns = std::min(a_state.executed_until_ns, b_state.executed_until_ns);
  if (to_ns <= from_ns || to_ns - from_ns <= 2 * clock_bound_ns_ + 1000) return std::nullopt;
  return 0;
}

bool Auditor::was_checked_against(const KnownVersion& granted, const KnownVersion& other) const {
  const Epoch epoch = granted.granted_in;
  if (!input_.is_complete) {
    // Pages show that the ledger held both. Two granted versions were checked, in whichever order. Others
    // enter the ledger unchecked: own stops, and versions of robots that register late.
    const bool are_listed = granted.listed_in == epoch && other.listed_in == epoch;
    const bool was_granted = other.granted_in == epoch && !other.is_own_stop;
    return are_listed && (was_granted || other.listed_from_ns <= granted.entered_after_ns);
  }
  if (!other.is_in(epoch)) return false;
  // An own stop enters the ledger unchecked. It constrains only versions granted after a page contained it.
  if (other.is_own_stop && other.granted_by_ns >= granted.granted_by_ns) return false;
  return other.granted_in == epoch || other.was_executed;
}

// Clocks of robots of one process are compared by the times at which it sent their facts.
bool Auditor::are_clocks_comparable(std::size_t a, std::size_t b) const {
  if (!has_sound_clock_[a] || !has_sound_clock_[b]) return false;
  return input_.is_complete ||
         (robots_[a].last_report && robots_[b].last_report &&
          robots_[a].last_report->robot_incarnation == robots_[b].last_report->robot_incarnation);
}

bool Auditor::may_conflict(const LiveVersion& mine, const Evidence& before, const LiveVersion& theirs) const {
  const bool by_grant = before.alive_until_ns < std::max(mine.granted_by_ns, theirs.granted_by_ns);
  const std::int64_t from_ns = std::max(mine.start_ns, theirs.start_ns) + 2 * clock_bound_ns_;
  const bool by_reports = std::min(before.executed_until_ns, theirs.executed_until_ns) <= from_ns + 1000 &&
                          std::min(mine.executed_until_ns, theirs.executed_until_ns) > from_ns;
  if (!by_grant && !by_reports) return false;
  const double dx = mine.x - theirs.x, dy = mine.y - theirs.y;
  const double max_distance_m =
      mine.reach_m + theirs.reach_m + 2 * scenario_.radius_m + scenario_.margin_m + 2 * max_inflation_m_;
  return dx * dx + dy * dy <= max_distance_m * max_distance_m;
}

void Auditor::check_pairs(const AuditedRobot& robot, const std::vector<Evidence>& before) {
  const std::size_t self = index_of(robot);
  bounds_[self] = collect_live_versions(robot, live_versions_[self]);
  // New proofs can only involve versions with new evidence.
  changed_.clear();
  BoundingDisc mine;
  for (const LiveVersion& own : live_versions_[self]) {
    if (evidence_of(robot.versions[own.index]) == before[own.index - robot.first_recent]) continue;
    changed_.push_back(own);
    mine.add(own);
  }
  if (changed_.empty()) return;
  const double separation_m = 2 * scenario_.radius_m + scenario_.margin_m + 2 * max_inflation_m_;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const BoundingDisc& other = bounds_[i];
    const double max_distance_m = mine.reach_m + other.reach_m + separation_m;
    const double dx = other.x - mine.x, dy = other.y - mine.y;
    if (i == self || other.reach_m < 0 || dx * dx + dy * dy > max_distance_m * max_distance_m) continue;
    const bool clocks_are_sound = are_clocks_comparable(self, i);
    for (const LiveVersion& own : changed_) {
      for (const LiveVersion& live : live_versions_[i]) {
        if (!may_conflict(own, before[own.index - robot.first_recent], live)) continue;
        const KnownVersion& known = robot.versions[own.index];
        const KnownVersion* theirs = robots_[i].find_near(live.index, live.number);
        if (!theirs || !theirs->has_content) continue;
        const Evidence state = evidence_of(*theirs);
        const auto epoch = common_epoch(known, evidence_of(known), *theirs, state);
        if (!epoch || (*epoch == 0 && !clocks_are_sound)) continue;
        const auto earlier = common_epoch(known, before[own.index - robot.first_recent], *theirs, state);
        if (earlier && (*earlier != 0 || clocks_are_sound)) continue;
        check_pair(robot, known, robots_[i], *theirs, *epoch);
      }
    }
  }
}

void Auditor::check_new_pairs(AuditedRobot& robot, KnownVersion& known) {
  if (known.alive_until_ns < known.granted_by_ns) return;  // later facts or pages will trigger the comparison
  known.is_pair_checked = true;
  for (const AuditedRobot& other : robots_) {
    if (&other == &robot) continue;
    for (std::size_t l = other.first_recent; l < other.versions.size(); ++l) {
      const KnownVersion& theirs = other.versions[l];
      if (!theirs.has_content) continue;
      const auto epoch = common_epoch(known, evidence_of(known), theirs, evidence_of(theirs));
      if (epoch && *epoch != 0) check_pair(robot, known, other, theirs, *epoch);
    }
  }
}

void Auditor::check_pair(const AuditedRobot& ra, const KnownVersion& a, const AuditedRobot& rb,
                         const KnownVersion& b, Epoch epoch) {
  const double required_m = min_separation_m(a, b);
  ++totals_.compared_pairs;
  const ClosestApproach near = closest_approach(a.path, b.path, required_m);
  if (near.distance_m >= required_m - kLengthTolerance_m || (a.number == 0 && b.number == 0)) return;
  // A version is excused if its base was already too close and the version comes no closer.
  const auto a_excused = is_excused(ra, a, b, near.distance_m),
             b_excused = is_excused(rb, b, a, near.distance_m);
  if (a_excused.value_or(false) || b_excused.value_or(false)) return;
  if (!a_excused || !b_excused) {
    ++totals_.undecided_pairs;
    return;
  }
  Violation violation;
  violation.rule = AuditRule::kClearance;
  violation.robot = ra.id;
  violation.version = a.number;
  violation.other = rb.id;
  violation.other_version = b.number;
  violation.epoch = epoch;
  violation.detail = fmt::format("{:.6f} m apart at {:.6f} s, {:.6f} m required{}", near.distance_m,
                                 static_cast<double>(near.at_ns) * 1e-9, required_m,
                                 epoch == 0 ? "; both were executed at the same time" : "");
  report(std::move(violation));
}

std::optional<bool> Auditor::is_excused(const AuditedRobot& robot, const KnownVersion& later,
                                        const KnownVersion& other, double distance_m) const {
  if (later.is_own_stop || later.number == 0) return false;
  const KnownVersion* base = base_of(robot, later);
  if (!base) return std::nullopt;
  const double required_m = min_separation_m(later, other);
  const ClosestApproach before = closest_approach(base->path, other.path, required_m, later.path.start_ns());
  return before.distance_m < required_m && distance_m >= before.distance_m - kLengthTolerance_m;
}

}  // namespace sidestep
