// SPDX-License-Identifier: Apache-2.0
// Versions of two robots against each other.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "deploy/monitor/audit/auditor.hpp"

namespace sidestep {
namespace {

constexpr double kLength_m = 2e-6;

std::int64_t entered_ns(const Known& known, Epoch epoch) {
  return known.granted_in == epoch ? known.granted_by_ns : kAlways;
}

}  // namespace

Auditor::Before Auditor::state_of(const Known& known) {
  return {known.alive_until_ns, known.executed_until_ns, known.was_executed};
}

double Auditor::min_separation_m(const Known& a, const Known& b) const {
  return 2 * scenario_.radius_m + scenario_.margin_m + a.version.inflation_m() + b.version.inflation_m();
}

std::optional<Epoch> Auditor::held_together(const Known& a, const Before& a_state, const Known& b,
                                            const Before& b_state) const {
  // In one ledger: the later one was granted while no fact had excluded the earlier one. Which was the later
  // one does not matter where both were alive when both were granted.
  for (const Known* granted : {&a, &b}) {
    const Epoch epoch = granted->granted_in;
    if (epoch == 0 || granted->is_own || !a.is_in(epoch) || !b.is_in(epoch)) continue;
    const Known& other = granted == &a ? b : a;
    // The firmware's own enters unchecked: it counts only for what is granted after the ledger was seen to
    // hold it.
    if (other.is_own && !(how_.is_complete && other.granted_by_ns < granted->granted_by_ns)) continue;
    if (other.granted_in != epoch && !other.was_executed) continue;
    const std::int64_t both_ns = std::max(entered_ns(a, epoch), entered_ns(b, epoch));
    if (std::min(a_state.alive_until_ns, b_state.alive_until_ns) >= both_ns) return epoch;
  }
  // At once, by facts, whatever any ledger says.
  if (a.is_own || b.is_own || !a_state.was_executed || !b_state.was_executed) return std::nullopt;
  const std::int64_t from_ns = std::max(a.path.start_ns(), b.path.start_ns());
  const std::int64_t to_ns = std::min(a_state.executed_until_ns, b_state.executed_until_ns);
  if (to_ns <= from_ns || to_ns - from_ns <= 2 * clock_bound_ns_ + 1000) return std::nullopt;
  return 0;
}

bool Auditor::may_matter(const Live& mine, const Before& before, const Live& theirs) const {
  const bool by_grant = before.alive_until_ns < std::max(mine.granted_by_ns, theirs.granted_by_ns);
  const std::int64_t from_ns = std::max(mine.start_ns, theirs.start_ns) + 2 * clock_bound_ns_;
  const bool by_facts = std::min(before.executed_until_ns, theirs.executed_until_ns) <= from_ns + 1000 &&
                        std::min(mine.executed_until_ns, theirs.executed_until_ns) > from_ns;
  if (!by_grant && !by_facts) return false;
  const double dx = mine.x - theirs.x, dy = mine.y - theirs.y;
  const double far =
      mine.reach_m + theirs.reach_m + 2 * scenario_.radius_m + scenario_.margin_m + 2 * max_inflation_m_;
  return dx * dx + dy * dy <= far * far;
}

void Auditor::judge_pairs_of(const AuditedRobot& robot, const std::vector<Before>& before) {
  const std::size_t self = index_of(robot);
  whereabouts_[self] = look_at(robot, live_[self]);
  // Of which nothing new is known, nothing new can be proven.
  changed_.clear();
  Whereabouts mine;
  for (const Live& own : live_[self]) {
    if (state_of(robot.versions[own.index]) == before[own.index - robot.first_recent]) continue;
    changed_.push_back(own);
    mine.add(own);
  }
  if (changed_.empty()) return;
  const double keep = 2 * scenario_.radius_m + scenario_.margin_m + 2 * max_inflation_m_;
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const Whereabouts& other = whereabouts_[i];
    const double far = mine.reach_m + other.reach_m + keep, dx = other.x - mine.x, dy = other.y - mine.y;
    if (i == self || other.reach_m < 0 || dx * dx + dy * dy > far * far) continue;
    const bool clocks_are_sound = has_sound_clock_[self] && has_sound_clock_[i];
    for (const Live& own : changed_) {
      for (const Live& live : live_[i]) {
        if (!may_matter(own, before[own.index - robot.first_recent], live)) continue;
        const Known& known = robot.versions[own.index];
        const Known* theirs = robots_[i].find_near(live.index, live.number);
        if (!theirs || !theirs->has_content) continue;
        const Before state = state_of(*theirs);
        const auto epoch = held_together(known, state_of(known), *theirs, state);
        if (!epoch || (*epoch == 0 && !clocks_are_sound)) continue;
        const auto earlier = held_together(known, before[own.index - robot.first_recent], *theirs, state);
        if (earlier && (*earlier != 0 || clocks_are_sound)) continue;
        judge_pair(robot, known, robots_[i], *theirs, *epoch);
      }
    }
  }
}

void Auditor::judge_new_pairs_of(AuditedRobot& robot, const Known& known) {
  if (known.alive_until_ns < known.granted_by_ns) return;  // facts will come
  for (const AuditedRobot& other : robots_) {
    if (&other == &robot) continue;
    for (std::size_t l = other.first_recent; l < other.versions.size(); ++l) {
      const Known& theirs = other.versions[l];
      if (!theirs.has_content) continue;
      const auto epoch = held_together(known, state_of(known), theirs, state_of(theirs));
      if (epoch && *epoch != 0) judge_pair(robot, known, other, theirs, *epoch);
    }
  }
}

void Auditor::judge_pair(const AuditedRobot& ra, const Known& a, const AuditedRobot& rb, const Known& b,
                         Epoch epoch) {
  const double keep = min_separation_m(a, b);
  ++totals_.pairs;
  const Approach near = nearest(a.path, b.path, keep);
  if (near.distance_m >= keep - kLength_m || (a.number == 0 && b.number == 0)) return;
  // Where the base was too near already, the version may lead away from there.
  const auto a_excused = is_excused(ra, a, b, near.distance_m),
             b_excused = is_excused(rb, b, a, near.distance_m);
  if (a_excused.value_or(false) || b_excused.value_or(false)) return;
  if (!a_excused || !b_excused) {
    ++totals_.unjudged;
    return;
  }
  Violation violation;
  violation.rule = AuditRule::kClearance;
  violation.robot = ra.id;
  violation.version = a.number;
  violation.other = rb.id;
  violation.other_version = b.number;
  violation.epoch = epoch;
  violation.what = fmt::format("{:.6f} m apart at {:.6f} s, {:.6f} m required{}", near.distance_m,
                               static_cast<double>(near.at_ns) * 1e-9, keep,
                               epoch == 0 ? "; both were executed at one time" : "");
  report(std::move(violation));
}

std::optional<bool> Auditor::is_excused(const AuditedRobot& robot, const Known& later, const Known& other,
                                        double distance_m) const {
  if (later.is_own || later.number == 0) return false;
  const Known* base = robot.find(later.version.base());
  if (!base || !base->has_content) return std::nullopt;
  const double keep = min_separation_m(later, other);
  const Approach before = nearest(base->path, other.path, keep, later.path.start_ns());
  return before.distance_m < keep && distance_m >= before.distance_m - kLength_m;
}

}  // namespace sidestep
