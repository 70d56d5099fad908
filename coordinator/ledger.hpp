// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/motion/validity.hpp"
#include "common/motion/version_set.hpp"
#include "coordinator/disc_grid.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// Why a version is refused, and for REASON_CONFLICT the conflicting robot.
struct Ruling {
  msg::Reason reason = msg::Reason::REASON_GRANTED;
  RobotId blocker = 0;

  bool is_granted() const { return reason == msg::Reason::REASON_GRANTED; }
};

/// Effect of a fact reported by a robot.
enum class FactOutcome {
  kApplied,
  kStale,          ///< superseded by a later fact
  kContradiction,  ///< inconsistent with the ledger, so the ledger is wrong
};

/// Two robots that may come closer than their margin and inflations permit; the lower number first.
using Conflict = std::pair<RobotId, RobotId>;

/// For every robot, the versions that it may execute, now or later; implements the rules of PROTOCOL.md, "The
/// ledger". Invariant: every version of one robot is clear of every version of every other robot, except for
/// the pairs in conflicts(), which external events have brought too close; no grant brings those closer. A
/// robot without versions is not on the floor.
class Ledger {
 public:
  /// `roster`: the robots that the ledger covers.
  Ledger(const FloorRules& rules, std::vector<RobotId> roster);

  bool has_robot(RobotId robot) const { return index_of(robot) < roster_.size(); }
  std::span<const RobotId> roster() const { return roster_; }
  std::span<const Version> versions(RobotId robot) const;

  /// Adds, without checks, the versions that a robot may execute when an epoch begins. Precondition: the
  /// robot is on the roster and has no versions.
  void register_robot(RobotId robot, std::span<const Version> versions);

  /// Rules 1, 4 and 5: adds the candidate if it may be granted. Removes nothing; a refusal changes nothing.
  [[nodiscard]] Ruling grant(const Version& candidate);

  /// Rules 2, 3 and 6, for the fact "executing f at time t". A robot off its reference executes a stop of
  /// its own, which replaces all older versions without checks. `life` is the incarnation of the robot.
  [[nodiscard]] FactOutcome on_executing(const Version& executing, Time at, bool is_off_reference,
                                         Incarnation life = 0);
  /// Rule 5, for the fact "off the floor at time t, executing nothing": drops all versions that start at or
  /// before t.
  void on_lifted(RobotId robot, Time at, Incarnation life = 0);

  /// In no particular order.
  std::span<const Conflict> conflicts() const { return conflicts_; }

  void clear();

 private:
  struct Entry {
    VersionSet set;
    // Bounding disc of each version's motion, including its inflation.
    std::array<Circle, VersionSet::kCapacity> discs;
    // Latest time at which it was reported off the floor, and its incarnation then. After a restart its clock
    // may be behind that time.
    Time lifted_at{};
    Incarnation lifted_life = 0;
  };
  std::size_t index_of(RobotId robot) const;
  Entry& entry_of(RobotId robot) { return entries_[index_of(robot)]; }
  /// Recomputes the bounding discs of the robot's versions.
  void update_bounds(std::size_t index);
  msg::Reason refusal_reason(const Version& candidate, const Version* base) const;
  /// Whether the candidate is clear of `other`, or is allowed by the escape rule with respect to `base`;
  /// if `base` is null, the escape rule does not apply.
  bool are_compatible(const Version& candidate, const Version* base, const Version& other) const;
  std::optional<RobotId> find_blocker(const Version& candidate, const Version* base);
  bool are_in_conflict(const Entry& a, const Entry& b) const;
  /// Recomputes the robot's conflicts.
  void find_conflicts(RobotId robot);
  /// Removes the robot's conflicts that have ended.
  void end_conflicts(RobotId robot);

  FloorRules rules_;
  std::vector<RobotId> roster_;     // ascending
  std::vector<std::size_t> index_;  // by robot
  std::vector<Entry> entries_;      // parallel to roster_
  DiscGrid grid_;                   // bounding discs of all entries with versions
  std::vector<std::uint32_t> nearby_;
  std::vector<Conflict> conflicts_;
};

}  // namespace sidestep
