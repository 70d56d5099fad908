// SPDX-License-Identifier: Apache-2.0
#include "deploy/audit/pair_audit.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace sidestep {
namespace {

std::int64_t entry_ns(const KnownVersion& known, Epoch epoch) {
  return known.granted_in == epoch ? known.granted_by_ns : kAlways;
}

}  // namespace

PairAudit::PairAudit(const AuditedRun& run, const RobotRecords& robots, AuditFindings& findings)
    : run_(run),
      robots_(robots),
      findings_(findings),
      clock_bound_ns_(run.clock_bound_ns()),
      bounds_(robots.all().size()),
      live_versions_(robots.all().size()) {}

double PairAudit::min_separation_m(const KnownVersion& a, const KnownVersion& b) const {
  return 2 * run_.scenario.radius_m + run_.scenario.margin_m + a.version.inflation_m() +
         b.version.inflation_m();
}

std::optional<Epoch> PairAudit::common_epoch(const KnownVersion& a, const Evidence& a_state,
                                             const KnownVersion& b, const Evidence& b_state) const {
  // Proof by a ledger: no report had excluded one version when the other one was granted.
  for (const KnownVersion* granted : {&a, &b}) {
    const Epoch epoch = granted->granted_in;
    if (epoch == 0 || granted->is_own_stop || !was_checked_against(*granted, granted == &a ? b : a)) continue;
    const std::int64_t both_ns = std::max(entry_ns(a, epoch), entry_ns(b, epoch));
    if (std::min(a_state.in_ledger_until_ns, b_state.in_ledger_until_ns) >= both_ns) return epoch;
  }
  // Proof by reports: both versions were executed at the same time, regardless of the ledgers' contents.
  if (a.is_own_stop || b.is_own_stop || !a_state.was_executed || !b_state.was_executed) return std::nullopt;
  const std::int64_t from_ns = std::max(a.path.start_ns(), b.path.start_ns());
  const std::int64_t to_ns = std::min(a_state.executed_until_ns, b_state.executed_until_ns);
  if (to_ns <= from_ns || to_ns - from_ns <= 2 * clock_bound_ns_ + 1000) return std::nullopt;
  return 0;
}

bool PairAudit::was_checked_against(const KnownVersion& granted, const KnownVersion& other) const {
  const Epoch epoch = granted.granted_in;
  if (!run_.is_complete()) {
    // Pages show that the ledger held both versions. If both were granted, the one granted later was checked
    // against the other. Own stops and versions of robots that register late enter the ledger unchecked.
    const bool are_listed = granted.listed_in == epoch && other.listed_in == epoch;
    const bool was_granted = other.granted_in == epoch && !other.is_own_stop;
    return are_listed && (was_granted || other.listed_from_ns <= granted.entered_after_ns);
  }
  if (!other.is_in(epoch)) return false;
  // An own stop enters the ledger unchecked. It constrains only versions granted after a page contained it.
  if (other.is_own_stop && other.granted_by_ns >= granted.granted_by_ns) return false;
  return other.granted_in == epoch || other.was_executed;
}

// Clocks of robots in one process can be compared, because that process stamps the reports of all of them.
bool PairAudit::are_clocks_comparable(const AuditedRobot& a, const AuditedRobot& b) const {
  if (!a.last_report || !b.last_report || !a.last_report->is_clock_sound || !b.last_report->is_clock_sound)
    return false;
  return run_.is_complete() || a.last_report->robot_incarnation == b.last_report->robot_incarnation;
}

bool PairAudit::may_conflict(const LiveVersion& mine, const Evidence& before,
                             const LiveVersion& theirs) const {
  const bool by_grant = before.in_ledger_until_ns < std::max(mine.granted_by_ns, theirs.granted_by_ns);
  const std::int64_t from_ns = std::max(mine.start_ns, theirs.start_ns) + 2 * clock_bound_ns_;
  const bool by_reports = std::min(before.executed_until_ns, theirs.executed_until_ns) <= from_ns + 1000 &&
                          std::min(mine.executed_until_ns, theirs.executed_until_ns) > from_ns;
  if (!by_grant && !by_reports) return false;
  const double dx = mine.x - theirs.x, dy = mine.y - theirs.y;
  const double max_distance_m = mine.reach_m + theirs.reach_m + 2 * run_.scenario.radius_m +
                                run_.scenario.margin_m + 2 * robots_.max_inflation_m();
  return dx * dx + dy * dy <= max_distance_m * max_distance_m;
}

void PairAudit::remember_evidence(const AuditedRobot& robot) {
  before_.clear();
  for (std::size_t i = robot.first_recent; i < robot.versions.size(); ++i)
    before_.emplace_back(robot.versions[i]);
}

void PairAudit::check_changes(const AuditedRobot& robot) {
  const std::size_t self = robots_.index_of(robot);
  bounds_[self] = collect_live_versions(robot, live_versions_[self]);
  // New proofs can only involve versions with new evidence.
  changed_.clear();
  BoundingDisc mine;
  for (const LiveVersion& own : live_versions_[self]) {
    if (Evidence(robot.versions[own.index]) == before_[own.index - robot.first_recent]) continue;
    changed_.push_back(own);
    mine.add(own);
  }
  if (changed_.empty()) return;
  const double separation_m =
      2 * run_.scenario.radius_m + run_.scenario.margin_m + 2 * robots_.max_inflation_m();
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    const BoundingDisc& other = bounds_[i];
    const double max_distance_m = mine.reach_m + other.reach_m + separation_m;
    const double dx = other.x - mine.x, dy = other.y - mine.y;
    if (i == self || other.reach_m < 0 || dx * dx + dy * dy > max_distance_m * max_distance_m) continue;
    check_changes(robot, i);
  }
}

void PairAudit::check_changes(const AuditedRobot& robot, std::size_t other) {
  const AuditedRobot& other_robot = robots_.all()[other];
  const bool clocks_are_sound = are_clocks_comparable(robot, other_robot);
  for (const LiveVersion& own : changed_) {
    const Evidence& before = before_[own.index - robot.first_recent];
    for (const LiveVersion& live : live_versions_[other]) {
      if (!may_conflict(own, before, live)) continue;
      const KnownVersion& known = robot.versions[own.index];
      const KnownVersion* theirs = other_robot.find_near(live.index, live.number);
      if (!theirs || !theirs->has_content) continue;
      const Evidence state(*theirs);
      const auto epoch = common_epoch(known, Evidence(known), *theirs, state);
      if (!epoch || (*epoch == 0 && !clocks_are_sound)) continue;
      const auto earlier = common_epoch(known, before, *theirs, state);
      if (earlier && (*earlier != 0 || clocks_are_sound)) continue;
      check_pair(robot, known, other_robot, *theirs, *epoch);
    }
  }
}

void PairAudit::check_new(const AuditedRobot& robot, KnownVersion& known) {
  if (known.in_ledger_until_ns < known.granted_by_ns)
    return;  // later reports or pages will trigger the comparison
  known.is_pair_checked = true;
  for (const AuditedRobot& other : robots_.all()) {
    if (&other == &robot) continue;
    for (std::size_t l = other.first_recent; l < other.versions.size(); ++l) {
      const KnownVersion& theirs = other.versions[l];
      if (!theirs.has_content) continue;
      const auto epoch = common_epoch(known, Evidence(known), theirs, Evidence(theirs));
      if (epoch && *epoch != 0) check_pair(robot, known, other, theirs, *epoch);
    }
  }
}

void PairAudit::check_pair(const AuditedRobot& ra, const KnownVersion& a, const AuditedRobot& rb,
                           const KnownVersion& b, Epoch epoch) {
  const double required_m = min_separation_m(a, b);
  ++findings_.totals.compared_pairs;
  const ClosestApproach near = closest_approach(a.path, b.path, required_m);
  if (near.distance_m >= required_m - kLengthTolerance_m || (a.number == 0 && b.number == 0)) return;
  // A version is excused if its base was already too close and the version comes no closer.
  const auto a_excused = is_excused(ra, a, b, near.distance_m),
             b_excused = is_excused(rb, b, a, near.distance_m);
  if (a_excused.value_or(false) || b_excused.value_or(false)) return;
  if (!a_excused || !b_excused) {
    ++findings_.totals.undecided_pairs;
    return;
  }
  findings_.report({AuditRule::kClearance,
                    {},
                    ra.id,
                    rb.id,
                    a.number,
                    b.number,
                    epoch,
                    fmt::format("{:.6f} m apart at {:.6f} s, {:.6f} m required{}", near.distance_m,
                                static_cast<double>(near.at_ns) * 1e-9, required_m,
                                epoch == 0 ? "; both were executed at the same time" : "")});
}

std::optional<bool> PairAudit::is_excused(const AuditedRobot& robot, const KnownVersion& later,
                                          const KnownVersion& other, double distance_m) const {
  if (later.is_own_stop || later.number == 0) return false;
  const KnownVersion* base = robots_.base_of(robot, later);
  if (!base) return std::nullopt;
  const double required_m = min_separation_m(later, other);
  const ClosestApproach before = closest_approach(base->path, other.path, required_m, later.path.start_ns());
  return before.distance_m < required_m && distance_m >= before.distance_m - kLengthTolerance_m;
}

}  // namespace sidestep
