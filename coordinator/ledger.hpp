// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "coordinator/disc_grid.hpp"
#include "common/motion/validity.hpp"
#include "common/motion/version_set.hpp"

namespace sidestep {

/// Why a version is not granted, and who is in the way if somebody is.
struct Ruling {
  msg::Reason reason = msg::REASON_GRANTED;
  RobotId blocker = 0;

  bool granted() const { return reason == msg::REASON_GRANTED; }
};

/// What became of a fact that a robot has told.
enum class FactUse {
  kUsed,
  kLate,           ///< says nothing any more
  kContradiction,  ///< cannot be true if the ledger is: the ledger is wrong
};

/// Two robots that may come nearer to each other than they should, the lower number first.
using Conflict = std::pair<RobotId, RobotId>;

/// For every robot, the versions that it may be executing, now or later (safety-protocol, "The ledger's
/// rules"). Invariant: every version of one robot is clear of every version of every other robot, but for the
/// pairs of robots in conflicts(), which something outside has brought too near; those come no nearer by what
/// is granted. A robot without versions is not on the floor.
class Ledger {
 public:
  /// Robots that are not on the roster do not exist.
  Ledger(const FloorRules& rules, std::vector<RobotId> roster);

  bool knows(RobotId robot) const { return index_of(robot) < roster_.size(); }
  std::span<const RobotId> roster() const { return roster_; }
  std::span<const Version> versions(RobotId robot) const;

  /// Enters, unchecked, what a robot may be executing when a coordinator's life begins. The robot has to be
  /// known and to have no versions yet.
  void enter(RobotId robot, std::span<const Version> versions);

  /// Rule 1: adds the candidate if it may be granted, removes nothing. A refused one changes nothing. A robot
  /// that is not on the floor is granted nothing but a stand.
  Ruling grant(const Version& candidate);

  /// Rule 2: "executing f at time t". Off its reference, a robot executes what it made itself, and that
  /// replaces all older versions, unchecked.
  FactUse on_executing(const Version& executing, Time at, bool is_off_reference);
  /// "Off the floor and executing nothing at time t": drops every version whose start is not after it.
  void on_lifted(RobotId robot, Time at);

  /// Pairs of robots that may come too near, in no order.
  std::span<const Conflict> conflicts() const { return conflicts_; }

  void clear();

 private:
  struct Entry {
    VersionSet set;
    std::array<Circle, VersionSet::kCapacity>
        discs;         // that the set's versions, with their growth, never leave
    Time lifted_at{};  // when it was last known to execute nothing
  };
  std::size_t index_of(RobotId robot) const;
  Entry& entry_of(RobotId robot) { return entries_[index_of(robot)]; }
  /// Finds the discs of the robot's versions, and of all together, anew.
  void bound(std::size_t index);
  msg::Reason refusal_of(const Version& candidate, const Version* base) const;
  /// Whether both of them may be taken, where `base` (may be nullptr) is what the candidate continues.
  bool may_both(const Version& candidate, const Version* base, const Version& other) const;
  std::optional<RobotId> blocker_of(const Version& candidate, const Version* base);
  bool are_in_conflict(const Entry& a, const Entry& b) const;
  /// Finds the robot's conflicts anew.
  void find_conflicts(RobotId robot);
  /// Drops those of the robot's conflicts that are over.
  void end_conflicts(RobotId robot);

  FloorRules rules_;
  std::vector<RobotId> roster_;     // ascending
  std::vector<std::size_t> index_;  // by robot
  std::vector<Entry> entries_;      // as roster_
  DiscGrid places_;                 // of the entries that have versions
  std::vector<std::uint32_t> near_;
  std::vector<Conflict> conflicts_;
};

}  // namespace sidestep
