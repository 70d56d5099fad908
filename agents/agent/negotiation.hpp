// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "common/motion/version_set.hpp"
#include "idl/negotiation.h"
#include "idl/robot.h"

namespace sidestep {

/// The agent's side of the safety protocol: fences its robot, registers with the coordinator, proposes, and
/// forwards what was granted and nothing else. When nothing comes in time it does nothing, and the robot
/// brakes.
class Negotiation {
 public:
  Negotiation(RobotId robot, Incarnation incarnation);

  /// A fact from the robot. The first one that acknowledges this incarnation ends the fencing.
  void on_feedback(const msg::Feedback& feedback);
  void on_coordinator_state(const msg::CoordinatorState& state);
  /// The granted version, if this is the answer to the outstanding proposal and there is time left to obey
  /// it. The caller forwards it to the robot.
  std::optional<Version> on_verdict(const msg::Verdict& verdict, Time now);

  bool is_fenced() const { return fenced_; }
  /// A later agent drives the robot: this one has nothing to say any more.
  bool is_superseded() const { return superseded_; }
  bool needs_registration() const {
    return fenced_ && !superseded_ && epoch_ != 0 && (unannounced_ || missing_);
  }
  /// Whether a proposal may be granted at all now.
  bool may_propose() const {
    return fenced_ && !superseded_ && epoch_ != 0 && !unannounced_ && granting_ && !held_.is_full();
  }
  /// Whether the next version after `now` is decided already, or being decided.
  bool is_settled_after(Time now) const;
  /// How many cycles ahead to propose, and to hold an acceleration: one, and more where versions keep coming
  /// too late.
  int lead() const { return lead_; }
  /// What was proposed last, or forwarded, rests on a base that the robot turned out not to be executing.
  bool is_contradicted() const { return contradicted_; }

  msg::Registration registration();
  /// The version that the robot will be executing at a time, as far as is known. Precondition: is_fenced().
  const Version& base_at(Time start) const;
  /// The version that the robot was executing by its latest fact. Precondition: is_fenced().
  const Version& executing() const { return *held_.find(executing_); }
  /// Drops the outstanding proposal, if any, and makes a new one. Precondition: 1 to MAX_CANDIDATES
  /// candidates that continue `base` at one start time.
  msg::Proposal propose(std::span<const Trajectory> candidates, VersionNumber base, Time now);

  /// Closes the cycle that ends now: a proposal for it that has no verdict is given up, and counted.
  void close_cycle(Time now);

  struct Counts {
    std::uint64_t proposals = 0, grants = 0, denials = 0;
    std::uint64_t cycles = 0;   ///< cycles for which something was proposed
    std::uint64_t missed = 0;  ///< cycles for which there was no verdict in time
    std::uint64_t lost = 0;    ///< forwarded, not taken by the robot
    std::uint64_t invalid = 0;
  };
  const Counts& counts() const { return counts_; }
  /// From the last answered proposal to its verdict.
  Duration last_round_trip() const { return last_round_trip_; }

 private:
  struct Outstanding {
    std::array<Version, msg::MAX_CANDIDATES> candidates;
    std::size_t count = 0;
    Time proposed_at{};

    VersionNumber number() const { return candidates.front().number; }
    Time start() const { return candidates.front().trajectory.start(); }
  };
  void adopt(const Version& executing);
  void on_taken();
  void on_late();
  void check_assumptions();

  RobotId robot_;
  Incarnation incarnation_;
  bool fenced_ = false, superseded_ = false, contradicted_ = false;
  Epoch epoch_ = 0;
  bool unannounced_ = true;                  // this agent has not registered in this epoch, or was not heard
  bool missing_ = false, granting_ = false;  // what the coordinator says
  VersionSet held_;                          // what the robot may be executing, now or later
  VersionNumber executing_ = 0;
  VersionNumber next_number_;
  std::optional<Outstanding> outstanding_;
  int lead_ = 1;
  int taken_in_a_row_ = 0, late_in_a_row_ = 0;
  Counts counts_;
  Duration last_round_trip_{0};
};

}  // namespace sidestep
