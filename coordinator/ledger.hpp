// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "common/motion/disc_grid.hpp"
#include "common/motion/validity.hpp"
#include "common/motion/version_set.hpp"

namespace sidestep {

/// Why a version is not granted, and who is in the way if somebody is.
struct Ruling {
  msg::Reason reason = msg::REASON_GRANTED;
  RobotId blocker = 0;

  bool granted() const { return reason == msg::REASON_GRANTED; }
};

/// For every robot, the versions that it may be executing, now or later (safety-protocol, "The ledger's
/// rules"). Invariant: every version of one robot is clear of every version of every other robot.
class Ledger {
 public:
  /// Robots that are not on the roster do not exist.
  Ledger(const FloorRules& rules, std::vector<RobotId> roster);

  bool knows(RobotId robot) const { return index_of(robot) < roster_.size(); }
  std::span<const RobotId> roster() const { return roster_; }
  std::span<const Version> versions(RobotId robot) const;

  /// Enters what a robot may be executing when a coordinator's life begins. The robot has to be known and to
  /// have no versions yet. Returns a robot that one of the versions is not clear of, if the floor begins with
  /// such a pair: then neither of the two is granted anything.
  std::optional<RobotId> enter(RobotId robot, std::span<const Version> versions);

  /// Rule 1: adds the candidate if it may be granted, removes nothing. A refused one changes nothing.
  Ruling grant(const Version& candidate);

  /// Rule 2: "executing f at time t". False when f is not among the robot's versions, which changes nothing.
  bool forget(RobotId robot, VersionNumber executing, Time at);

  void clear();

 private:
  struct Entry {
    VersionSet set;
    std::array<Circle, VersionSet::kCapacity> discs;  // that the set's versions never leave
  };
  std::size_t index_of(RobotId robot) const;
  /// Finds the discs of the robot's versions, and of all together, anew.
  void bound(std::size_t index);
  std::optional<RobotId> blocker_of(const Trajectory& trajectory, RobotId robot);

  FloorRules rules_;
  std::vector<RobotId> roster_;     // ascending
  std::vector<std::size_t> index_;  // by robot
  std::vector<Entry> entries_;      // as roster_
  DiscGrid places_;                 // of the entries that have versions
  std::vector<std::uint32_t> near_;
};

}  // namespace sidestep
