// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "agents/agent/coordinator_contact.hpp"
#include "agents/agent/fencing.hpp"
#include "agents/agent/held_versions.hpp"
#include "agents/agent/proposal_pacing.hpp"
#include "agents/agent/sent_proposals.hpp"
#include "agents/agent/wait_reason.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// The agent's side of the safety protocol (coordinator/PROTOCOL.md): fences its robot, registers with the
/// coordinator, proposes, and forwards only granted versions. If no verdict arrives in time it does nothing,
/// and the robot brakes. The caller decodes messages before it passes them to this class. It sends the
/// messages that this class returns, and sets their send time.
class Negotiation {
 public:
  /// The consequences of a verdict for the agent.
  struct VerdictResult {
    /// The version to forward to the robot; nullopt if no version was granted in time.
    std::optional<Version> granted;
    std::optional<Duration> round_trip;  ///< round trip of the proposal that the verdict grants or denies
  };
  struct Counts {
    std::uint64_t proposals = 0, grants = 0, denials = 0;
    std::uint64_t cycles = 0;  ///< number of cycles in which the agent has proposed
    std::uint64_t missed = 0;  ///< number of cycles without a verdict in time
    std::uint64_t lost = 0;    ///< number of forwarded versions that the robot did not activate
    // Counts of messages that were not used.
    std::uint64_t unproposed_grants = 0, unexpected_verdicts = 0, late_reports = 0, old_epochs = 0;
  };

  Negotiation(RobotId robot, Incarnation incarnation, Duration cycle);

  /// Processes a report of the robot. The first report that acknowledges this incarnation ends the fencing.
  void on_robot_report(const RobotReport& robot_report);
  void on_coordinator_state(const CoordinatorHeartbeat& heartbeat, Time now);
  VerdictResult on_verdict(const Verdict& verdict, Time now);

  /// See Fencing.
  Incarnation robot_incarnation() const { return fencing_.robot_incarnation(); }
  /// The incarnation sent with commands, and the highest known epoch. The incarnation changes only before the
  /// robot has acknowledged this agent.
  Incarnation incarnation() const { return fencing_.incarnation(); }
  Epoch epoch() const { return epoch_; }
  /// The epoch sent with commands. It is 0 until the robot has acknowledged this agent; the acknowledgement
  /// therefore shows which epoch the robot obeyed before.
  Epoch command_epoch() const { return is_fenced() ? epoch_ : 0; }
  bool is_fenced() const { return fencing_.is_fenced(); }
  /// Whether the robot is off the floor and executes nothing. It may still accept a rest version.
  bool is_absent() const { return is_fenced() && !held_.is_executing(); }
  /// Whether the robot obeys a later agent. If so, this agent stays silent.
  bool is_superseded() const { return fencing_.is_superseded(); }
  bool must_query_robot() const { return fencing_.must_query_robot(cycle_); }
  /// Whether the agent must register. It registers only after the robot has acknowledged the epoch. So an
  /// agent that the robot does not obey cannot register, and no later agent of the robot can return to an
  /// older coordinator.
  bool needs_registration() const {
    return !is_superseded() && is_epoch_obeyed() && (registration_pending_ || contact_.is_robot_missing());
  }
  /// Whether the coordinator may grant a proposal at this time.
  bool may_propose(Time now) const { return wait_reason(now) == WaitReason::kNone; }
  /// Why the coordinator may not grant a proposal, as far as the negotiation knows.
  WaitReason wait_reason(Time now) const;
  /// Whether the coordinator has registered this agent in the epoch, as far as the agent knows.
  bool is_registered() const {
    return is_epoch_obeyed() && !registration_pending_ && !contact_.is_robot_missing() &&
           contact_.has_been_heard();
  }
  /// Whether a version that starts after `now` has been granted or awaits its verdict.
  bool has_upcoming_version(Time now) const;
  /// The start of a version that should be proposed again because its answer is overdue.
  std::optional<Time> retry_start(Time now) const;
  /// Number of cycles to propose ahead. An acceleration is held for at most as many cycles.
  int lead() const { return pacing_.lead(); }
  /// Whether a report since the last proposal shows that the robot does not execute the version that the
  /// proposal assumed.
  bool is_contradicted() const { return contradicted_; }
  /// Whether the agent should repeat its registration to find another coordinator: no coordinator is active,
  /// it does not answer, or it does not know which versions the robot executes.
  bool needs_other_coordinator(Time now) const;

  Registration registration();
  /// Records that a request which the coordinator will answer has been sent.
  void on_request(Time now) { contact_.on_request(now); }
  /// A registration without a robot report. It asks the coordinator of the epoch to announce all orders, and
  /// informs other coordinators of the epoch.
  Registration epoch_notice() const { return {robot_, incarnation(), epoch_, Time{}, std::nullopt}; }
  /// The versions that the robot may be executing. Precondition: is_fenced().
  const HeldVersions& held() const { return held_; }
  /// Creates a proposal. Precondition: 1 to MAX_CANDIDATES candidates with the same start, all of which
  /// continue `base`; for an absent robot, a rest version on base 0. Candidates have no inflation: if the
  /// base has one, they start at rest.
  [[nodiscard]] Proposal propose(std::span<const Trajectory> candidates, VersionNumber base, Time now,
                                 const std::optional<Intent>& intent = std::nullopt);

  /// Closes the cycle that ends now: abandons its proposals without a verdict, and counts them as missed.
  void close_cycle(Time now);

  const Counts& counts() const { return counts_; }

 private:
  /// Whether the robot obeys this agent in the highest known epoch.
  bool is_epoch_obeyed() const { return is_fenced() && epoch_ != 0 && fencing_.robot_epoch() == epoch_; }
  void apply_report(const RobotReport& robot_report, bool is_current);
  void adopt_epoch(Epoch epoch);
  /// Forwards the granted candidate if it is in time.
  VerdictResult apply_grant(SentProposal& sent, const Verdict& verdict, Time now);

  RobotId robot_;
  Duration cycle_;
  Fencing fencing_;
  HeldVersions held_;
  SentProposals proposals_;
  CoordinatorContact contact_;
  Epoch epoch_ = 0;                   // highest epoch received
  bool registration_pending_ = true;  // not registered in this epoch, or the registration was lost
  bool contradicted_ = false;
  ProposalPacing pacing_;
  Counts counts_;
};

}  // namespace sidestep
