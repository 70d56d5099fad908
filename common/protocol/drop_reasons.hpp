// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace sidestep {

/// Why a process did not use a received message or a part of it, or did not send a message. The numbers are
/// used in messages.
enum class DropReason : std::uint16_t {
  // Counted by the bus of any process.
  kUnreadable,
  kOtherRules,
  kInjectedLoss,
  kQueueFull,
  kMalformedDatagram,
  kForgottenPeer,
  kUnknownParticipant,
  kRefusedParticipant,
  kForgedSender,
  kContestedSender,
  // Counted by any process that reads the topic.
  kMalformedFeedback,
  kMalformedVerdict,
  kMalformedObservation,
  kMalformedObstacles,
  kMalformedScan,
  kMalformedLedgerPage,
  kMalformedVersion,
  kMalformedCourse,
  kMalformedCourseOffer,
  kMalformedCoordinatorState,
  kMalformedRegistration,
  kMalformedProposal,
  kMalformedCommand,
  kMalformedPlacement,
  kMalformedOrder,
  kMalformedNetworkFault,
  kMalformedRules,
  kMalformedFrame,
  kMalformedDetection,
  kMalformedImage,
  kMalformedLeaguePacket,
  kFutureWorld,
  kFutureObservation,
  kFutureObstacles,
  kImplausibleEpoch,
  kFrequentEpoch,
  kFrequentCourse,
  kImplausibleClock,
  kUnknownRobot,
  // Counted by agents.
  kUnproposedGrant,
  kUnexpectedVerdict,
  kLateFact,
  kLatePage,
  kOldEpoch,
  // Counted by coordinators.
  kContradictoryFact,
  kFactOfHigherEpoch,
  kRefusedProposal,
  kRefusedRegistration,
  kRefusedAttestation,
  kRefusedOrder,
  // Counted by vision.
  kUntimelyFrame,
  kFalseDetection,
  kTooManyObstacles,
  kRepeatedLeagueFrame,
  kUndatedLeagueFrame,
  kUnusedLeagueDetection,
  kOtherLeagueSender,
  // Counted by the simulator and its robots.
  kCommandLost,
  kFencedCommand,
  kLateVersion,
  kWrongBase,
  kRefusedDisturbance,
  kUnsentLeaguePacket,
  // Counted by processes that drive third-party robots.
  kUnstoredCommand,
  kMalformedOdometry,
  kMisdatedOdometry,
  kRejectedByBase,
  // Counted by monitors.
  kUnusedByMonitor,
};

/// A row of the table of drop reasons.
struct DropReasonInfo {
  DropReason reason;
  const char* name;         ///< name in reports and in `sidestep topic echo`
  const char* description;  ///< description for documents
  bool is_unusual;          ///< whether only faulty, third-party or hostile processes cause it
};

/// Indexed by DropReason.
inline constexpr std::array kDropReasons = std::to_array<DropReasonInfo>({
    {DropReason::kUnreadable, "unreadable", "bytes that do not decode to a message of the topic", true},
    {DropReason::kOtherRules, "other_rules", "messages of processes with different rules", true},
    {DropReason::kInjectedLoss, "injected_loss", "messages lost by simulated or injected network faults",
     false},
    {DropReason::kQueueFull, "queue_full", "messages dropped because a queue was full", false},
    {DropReason::kMalformedDatagram, "malformed_datagram",
     "datagrams with wrong sizes or counts, which would harm the DDS library", true},
    {DropReason::kForgottenPeer, "forgotten_peer",
     "datagrams of a process that was forgotten after seconds of silence, until both sides have reset",
     false},
    {DropReason::kUnknownParticipant, "unknown_participant",
     "in a run with keys, datagrams of participants that have not announced a key", false},
    {DropReason::kRefusedParticipant, "refused_participant",
     "announcements of participants without a valid key of this network", true},
    {DropReason::kForgedSender, "forged_sender",
     "messages whose stated sender may not send them, or whose key belongs to another process", true},
    {DropReason::kContestedSender, "contested_sender",
     "messages on a single-writer topic while several processes write it", false},
    {DropReason::kMalformedFeedback, "malformed_feedback", "malformed feedback of robots", true},
    {DropReason::kMalformedVerdict, "malformed_verdict", "malformed verdicts", true},
    {DropReason::kMalformedObservation, "malformed_observation",
     "malformed observations of robots in world states", true},
    {DropReason::kMalformedObstacles, "malformed_obstacles", "malformed lists of obstacles", true},
    {DropReason::kMalformedScan, "malformed_scan",
     "malformed laser scans, and scans of a laser other than the scenario's", true},
    {DropReason::kMalformedLedgerPage, "malformed_ledger_page", "malformed pages of the ledger", true},
    {DropReason::kMalformedVersion, "malformed_version", "malformed versions on pages of the ledger", true},
    {DropReason::kMalformedCourse, "malformed_course", "malformed courses of robots", true},
    {DropReason::kMalformedCourseOffer, "malformed_course_offer", "malformed offers of courses", true},
    {DropReason::kMalformedCoordinatorState, "malformed_coordinator_state",
     "malformed heartbeats of coordinators", true},
    {DropReason::kMalformedRegistration, "malformed_registration", "malformed registrations", true},
    {DropReason::kMalformedProposal, "malformed_proposal", "malformed proposals", true},
    {DropReason::kMalformedCommand, "malformed_command", "malformed commands to robots", true},
    {DropReason::kMalformedPlacement, "malformed_placement", "malformed requests to put down a lifted robot",
     true},
    {DropReason::kMalformedOrder, "malformed_order", "malformed orders, and pages of remembered orders",
     true},
    {DropReason::kMalformedNetworkFault, "malformed_network_fault", "malformed requests for network faults",
     true},
    {DropReason::kMalformedRules, "malformed_rules", "malformed rules of other processes", true},
    {DropReason::kMalformedFrame, "malformed_frame", "malformed frames of detections", true},
    {DropReason::kMalformedDetection, "malformed_detection", "malformed detections in frames", true},
    {DropReason::kMalformedImage, "malformed_image",
     "camera images that are malformed, untimely or of an unknown camera", true},
    {DropReason::kMalformedLeaguePacket, "malformed_league_packet", "malformed packets of the league", true},
    {DropReason::kFutureWorld, "future_world", "world states whose time is ahead of the clock", true},
    {DropReason::kFutureObservation, "future_observation",
     "observations of the robot whose time is ahead of the clock", true},
    {DropReason::kFutureObstacles, "future_obstacles",
     "lists of obstacles, and obstacles in them, whose time is ahead of the clock", true},
    {DropReason::kImplausibleEpoch, "implausible_epoch", "epochs far ahead of the clock", true},
    {DropReason::kFrequentEpoch, "frequent_epoch",
     "reports of higher epochs beyond the number that a coordinator acts on", true},
    {DropReason::kFrequentCourse, "frequent_course",
     "courses and offers of courses beyond the number that a coordinator relays", true},
    {DropReason::kImplausibleClock, "implausible_clock", "time stamps that contradict each other", true},
    {DropReason::kUnknownRobot, "unknown_robot",
     "proposals, registrations, courses and detections of robots that the scenario does not have", true},
    {DropReason::kUnproposedGrant, "unproposed_grant", "grants of versions that were never proposed", true},
    {DropReason::kUnexpectedVerdict, "unexpected_verdict",
     "repeated verdicts, and verdicts of another epoch or for another agent", false},
    {DropReason::kLateFact, "late_fact", "facts that arrived after a later fact", false},
    {DropReason::kLatePage, "late_page", "pages of the ledger that arrived after a later page", false},
    {DropReason::kOldEpoch, "old_epoch", "heartbeats of an epoch below the highest known epoch", false},
    {DropReason::kContradictoryFact, "contradictory_fact", "facts that contradict the ledger", true},
    {DropReason::kFactOfHigherEpoch, "fact_of_higher_epoch",
     "facts about versions that a coordinator of a higher epoch may have granted", false},
    {DropReason::kRefusedProposal, "refused_proposal",
     "proposals of another epoch or agent, and proposals before all robots have registered", false},
    {DropReason::kRefusedRegistration, "refused_registration", "registrations of another epoch or agent",
     false},
    {DropReason::kRefusedAttestation, "refused_attestation",
     "attestations of robots that are not missing or have been heard", false},
    {DropReason::kRefusedOrder, "refused_order",
     "orders to unknown robots or to places outside the field, and orders replaced by a later order", false},
    {DropReason::kUntimelyFrame, "untimely_frame", "frames whose capture time is too old or in the future",
     false},
    {DropReason::kFalseDetection, "false_detection",
     "detections that belong to no track, or arrived too late", false},
    {DropReason::kTooManyObstacles, "too_many_obstacles",
     "detections of obstacles while all tracks were in use", false},
    {DropReason::kRepeatedLeagueFrame, "repeated_league_frame",
     "frames of the league that have already been received", false},
    {DropReason::kUndatedLeagueFrame, "undated_league_frame",
     "frames of the league whose capture time cannot be determined yet", false},
    {DropReason::kUnusedLeagueDetection, "unused_league_detection",
     "balls and obstacles beyond the capacity of a frame, robots without a heading, and fast robots in "
     "frames with an uncertain time",
     false},
    {DropReason::kOtherLeagueSender, "other_league_sender",
     "packets of the league from senders that are not used, because another one is", true},
    {DropReason::kCommandLost, "command_lost", "commands lost by the simulated radio", false},
    {DropReason::kFencedCommand, "fenced_command", "commands of an incarnation or epoch that a robot refuses",
     false},
    {DropReason::kLateVersion, "late_version", "versions that reached a robot after their start", false},
    {DropReason::kWrongBase, "wrong_base", "versions whose base a robot did not execute", false},
    {DropReason::kRefusedDisturbance, "refused_disturbance",
     "disturbances that are invalid, or that the robot's state does not allow", false},
    {DropReason::kUnsentLeaguePacket, "unsent_league_packet", "packets of the league that could not be sent",
     false},
    {DropReason::kUnstoredCommand, "unstored_command",
     "commands that a robot refused because it could not store its state", true},
    {DropReason::kMalformedOdometry, "malformed_odometry", "malformed odometry of bases", true},
    {DropReason::kMisdatedOdometry, "misdated_odometry",
     "odometry whose time stamp is later than its arrival, or implausible", true},
    {DropReason::kRejectedByBase, "rejected_by_base", "errors reported by bases or their simulator", true},
    {DropReason::kUnusedByMonitor, "unused_by_monitor",
     "invalid or outdated states that the run's metrics did not use", false},
});

inline constexpr std::size_t kDropReasonCount = kDropReasons.size();

/// Whether every row of the table is at the index that its reason's number requires.
constexpr bool are_drop_reasons_in_order() {
  for (std::size_t i = 0; i < kDropReasonCount; ++i) {
    if (static_cast<std::size_t>(kDropReasons[i].reason) != i) return false;
  }
  return static_cast<std::size_t>(DropReason::kUnusedByMonitor) + 1 == kDropReasonCount;
}
static_assert(are_drop_reasons_in_order());

constexpr const DropReasonInfo& info_of(DropReason reason) {
  return kDropReasons[static_cast<std::size_t>(reason)];
}

}  // namespace sidestep
