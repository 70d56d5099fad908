// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/motion/safety_budget.hpp"
#include "common/motion/validity.hpp"
#include "common/motion/version_set.hpp"
#include "common/time/clock_bounds.hpp"
#include "coordinator/disc_grid.hpp"
#include "coordinator/former_versions.hpp"
#include "idl/negotiation.hpp"

namespace sidestep {

/// The reason for the decision on a version, and for REASON_CONFLICT the conflicting robot.
struct Ruling {
  msg::Reason reason = msg::Reason::REASON_GRANTED;
  RobotId blocker = 0;

  bool is_granted() const { return reason == msg::Reason::REASON_GRANTED; }
};

/// Effect of a fact reported by a robot.
enum class ReportOutcome {
  kApplied,
  kStale,          ///< overtaken by a later fact
  kContradiction,  ///< contradicts the ledger; the robot is quarantined
};

/// Two robots that may come closer than their margin and inflations permit; the lower number first.
using Conflict = std::pair<RobotId, RobotId>;

/// Contains the versions that each robot may execute, now or later. Implements the rules of PROTOCOL.md, "The
/// ledger". Invariant: every version of one robot is clear of every version of every other robot, except for
/// the pairs in conflicts(), which external events have brought too close; no grant brings those closer. A
/// robot without versions is not on the floor. A robot that has reported a version that it was never granted
/// is quarantined: the ledger keeps all its versions and the reported version, until kReportsUntilReleased
/// consecutive facts agree with the ledger.
class Ledger {
 public:
  /// About one second at 60 Hz.
  static constexpr int kReportsUntilReleased = 60;

  /// `roster` lists the robots that the ledger covers. `max_clock_difference` is the maximum difference
  /// between the cameras' clock and a robot's.
  Ledger(const FloorRules& rules, std::vector<RobotId> roster,
         Duration max_clock_difference = sidestep::max_clock_difference(SafetyBudget{}.clock_bound_s));

  bool has_robot(RobotId robot) const { return index_of(robot) < roster_.size(); }
  std::span<const RobotId> roster() const { return roster_; }
  /// The robot's versions in the order in which they were added. Versions that it was never granted come
  /// last.
  std::span<const Version> versions(RobotId robot) const;
  bool is_quarantined(RobotId robot) const;
  /// Whether the versions include the version that the quarantined robot reported last. Precondition:
  /// is_quarantined().
  bool lists_reported(RobotId robot, std::span<const Version> versions) const;

  /// Replaces the robot's versions, without checks, by `versions`, which the robot may execute. Used when an
  /// epoch begins, and when a registration ends the robot's quarantine. Precondition: the robot is on the
  /// roster.
  void register_robot(RobotId robot, std::span<const Version> versions);

  /// Rules 1, 4 and 5: adds the candidate if it may be granted. Removes nothing; a refusal changes nothing.
  [[nodiscard]] Ruling grant(const Version& candidate);

  /// Rules 2, 3 and 6, for the fact "executing f at time t". A robot off its reference executes an own stop,
  /// which replaces all older versions without checks. `robot_incarnation` is the incarnation of the process
  /// that reports for the robot.
  [[nodiscard]] ReportOutcome on_executing(const Version& executing, Time at, bool is_off_reference,
                                           Incarnation robot_incarnation = 0);
  /// The outcome that on_executing() would return, without applying the fact.
  [[nodiscard]] ReportOutcome judge(const Version& executing, Time at, bool is_off_reference,
                                    Incarnation robot_incarnation) const;
  /// Rule 5, for the fact "off the floor at time t, executing nothing": drops all versions that start at or
  /// before t.
  void on_lifted(RobotId robot, Time at, Incarnation robot_incarnation = 0);

  /// The pairs of robots in conflict, in no particular order.
  std::span<const Conflict> conflicts() const { return conflicts_; }

  /// Distance from a position to the nearest place to which the robot's versions, including former versions,
  /// may have taken it at a time by the robot's clock, minus the version's inflation. Infinite for a robot
  /// that was not on the floor then; nullopt if the ledger does not reach back that far. Conservative: never
  /// overestimated while the robot's clock differs by at most `max_clock_difference`.
  std::optional<double> distance_from_versions_m(RobotId robot, const Vec2& position_m, Time at) const;
  /// Whether every version that the robot may have executed after `since` had ended by `since`: the robot
  /// rests. False for a robot without versions.
  bool rests_since(RobotId robot, Time since) const;

  void clear();

 private:
  struct Entry {
    VersionSet set;
    // Empty unless the robot is quarantined; then the versions of the set, followed by the ungranted version
    // that the robot reported last.
    std::vector<Version> quarantined;
    int agreeing = 0;  // number of consecutive facts that agree with the set, while quarantined
    FormerVersions former;
    // Bounding disc of each version's motion, including the version's inflation.
    std::array<Circle, VersionSet::kCapacity + 1> discs;
    // Latest time at which the robot was reported off the floor, and its incarnation then. After a restart
    // its clock may be behind that time.
    Time lifted_at{};
    Incarnation lifted_incarnation = 0;

    std::span<const Version> versions() const { return quarantined.empty() ? set.versions() : quarantined; }
    void quarantine(const Version& reported);
    void release() { quarantined.clear(); }
    /// Counts a fact that agrees with the set. Returns whether the robot is not in quarantine afterwards.
    bool record_agreement();
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
  /// Removes the conflicts of the robot that have ended.
  void end_conflicts(RobotId robot);

  FloorRules rules_;
  Duration max_clock_difference_;
  std::vector<RobotId> roster_;     // robot numbers, ascending
  std::vector<std::size_t> index_;  // indexed by robot
  std::vector<Entry> entries_;      // parallel to roster_
  DiscGrid grid_;                   // bounding discs of all entries with versions
  std::vector<std::uint32_t> nearby_;
  std::vector<Conflict> conflicts_;
};

}  // namespace sidestep
