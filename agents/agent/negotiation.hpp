// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "agents/agent/proposal_pacing.hpp"
#include "common/motion/version_set.hpp"
#include "idl/negotiation.h"
#include "idl/robot.h"

namespace sidestep {

/// The agent's side of the safety protocol: fences its robot, registers with the coordinator, proposes, and
/// forwards what was granted and nothing else. When nothing comes in time it does nothing, and the robot
/// brakes.
class Negotiation {
 public:
  Negotiation(RobotId robot, Incarnation incarnation, Duration cycle);

  /// A fact from the robot. The first one that acknowledges this incarnation ends the fencing.
  void on_feedback(const msg::Feedback& feedback);
  void on_coordinator_state(const msg::CoordinatorState& state, Time now);
  /// The granted version, if this is the answer to what was proposed and there is time left to obey it. The
  /// caller forwards it to the robot.
  std::optional<Version> on_verdict(const msg::Verdict& verdict, Time now);

  /// What commands have to carry. The incarnation grows only while the robot obeys nobody of this agent yet.
  Incarnation incarnation() const { return incarnation_; }
  Epoch epoch() const { return epoch_; }

  bool is_fenced() const { return fenced_; }
  /// The robot is not on the floor and executes nothing, whatever stand it may still take.
  bool is_absent() const { return fenced_ && !held_.find(executing_); }
  /// A later agent drives the robot: this one has nothing to say any more.
  bool is_superseded() const { return superseded_; }
  /// Registers only once the robot has acknowledged the epoch, so that no agent that it does not obey any
  /// more speaks for it, and no later agent of it falls back to an older coordinator.
  bool needs_registration() const {
    return fenced_ && !superseded_ && epoch_ != 0 && robot_epoch_ == epoch_ && (unannounced_ || missing_);
  }
  /// Whether a proposal may be granted at all now.
  bool may_propose(Time now) const;
  /// Whether the next version after `now` is decided already, or being decided.
  bool is_settled_after(Time now) const;
  /// The start of a version for which it is time to ask again, because no answer is to be expected any more.
  std::optional<Time> unanswered_start(Time now) const;
  /// How many cycles ahead to propose, and for how many to hold an acceleration at most.
  int lead() const { return pacing_.lead(); }
  /// What was proposed last, or forwarded, rests on a base that the robot turned out not to be executing.
  bool is_contradicted() const { return contradicted_; }

  msg::Registration registration();
  /// The version that the robot will be executing at a time, as far as is known. Precondition: is_fenced()
  /// and not is_absent().
  const Version& base_at(Time start) const;
  /// The version that the robot was executing by its latest fact. Precondition: is_fenced() and not
  /// is_absent().
  const Version& executing() const { return *held_.find(executing_); }
  /// Precondition: 1 to MAX_CANDIDATES candidates that continue `base` at one start time; or a stand on base
  /// 0 for a robot that is absent. `inflation_m` is the base's, or 0 from rest.
  msg::Proposal propose(std::span<const Trajectory> candidates, VersionNumber base, Time now,
                        double inflation_m = 0, const std::optional<Intent>& intent = std::nullopt);

  /// Closes the cycle that ends now: what was proposed for it and has no verdict is given up, and counted.
  void close_cycle(Time now);

  struct Counts {
    std::uint64_t proposals = 0, grants = 0, denials = 0;
    std::uint64_t cycles = 0;  ///< cycles for which something was proposed
    std::uint64_t missed = 0;  ///< cycles for which there was no verdict in time
    std::uint64_t lost = 0;    ///< forwarded, not taken by the robot
    std::uint64_t invalid = 0;
  };
  const Counts& counts() const { return counts_; }
  /// From the last answered proposal to its verdict.
  Duration last_round_trip() const { return last_round_trip_; }

 private:
  /// A proposal that was made.
  struct Asked {
    std::array<Version, msg::MAX_CANDIDATES> candidates;
    std::size_t count = 0;
    Time proposed_at{};
    int lead = 1;
    bool answered = true;
    bool open = false;  // if granted, it is forwarded

    VersionNumber number() const { return candidates.front().number; }
    Time start() const { return candidates.front().trajectory.start(); }
  };
  void adopt(const msg::Feedback& feedback, const Version& executing);
  void use_fact(const msg::Feedback& feedback, const Version& executing);
  /// The robot executes what this agent knows nothing of, and nothing else any more.
  void rebase(const Version& executing);
  bool rests_on(const Version& version) const;
  void adopt_epoch(Epoch epoch);
  void check_assumptions();
  /// When the last version begins that the robot will take, as far as is known.
  Time last_start() const;
  void close_all();
  const Asked& newest() const { return asked_[(asked_count_ - 1) % asked_.size()]; }

  RobotId robot_;
  Incarnation incarnation_;
  Duration cycle_;
  bool fenced_ = false, superseded_ = false, contradicted_ = false;
  Epoch epoch_ = 0, robot_epoch_ = 0;        // the highest seen, and the one that the robot has acknowledged
  bool unannounced_ = true;                  // this agent has not registered in this epoch, or was not heard
  bool missing_ = false, granting_ = false;  // what the coordinator says,
  Time heard_{};                             // and when it did
  VersionSet held_;                          // what the robot may be executing, now or later
  VersionNumber executing_ = 0;
  Time latest_fact_{};  // by the robot's clock
  VersionNumber next_number_;
  std::array<Asked, 8> asked_;
  std::size_t asked_count_ = 0;
  int asked_for_start_ = 0;
  ProposalPacing pacing_;
  Counts counts_;
  Duration last_round_trip_{0};
};

}  // namespace sidestep
