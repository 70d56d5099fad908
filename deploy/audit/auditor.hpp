// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/audit/audit_rules.hpp"
#include "deploy/audit/audit_shape.hpp"
#include "deploy/audit/audit_totals.hpp"
#include "deploy/audit/audited_robot.hpp"
#include "deploy/audit/comparable_stamps.hpp"
#include "deploy/audit/disturbances.hpp"
#include "deploy/audit/order_audit.hpp"
#include "deploy/audit/reception_coverage.hpp"
#include "deploy/audit/seen_contacts.hpp"
#include "deploy/inspect/senders/message_trace.hpp"

namespace sidestep {

/// Which messages the auditor receives, and how quickly.
struct AuditInput {
  /// Whether it receives every message from the start on, at the moment it is sent. Only then is a missing
  /// message evidence.
  bool is_complete = false;
  /// Upper bound of the minimum latency from any sender to the auditor. Unused if is_complete. A receiver
  /// that is overloaded exceeds it, so no violation relies on it.
  Duration min_latency_bound{5'000'000};
};

/// Checks all messages of a run against the rules of the safety protocol and reports each violation with the
/// robots and versions involved. Shares no code with the components under audit. The auditor may join late,
/// miss messages and receive them late and out of order. It then relies only on contradictions between
/// received messages that no missing message could resolve. So it finds less, but never raises a false alarm,
/// and its totals state how much it covered. In that case it knows the order of two messages only if they
/// have the same sender or if one refers to the other. Operators' messages must not be lost. Memory is
/// bounded by the roster.
class Auditor {
 public:
  Auditor(const Scenario& scenario, const AuditInput& input);

  void on_proposal(const msg::Proposal& proposal, Time now);
  void on_verdict(const msg::Verdict& verdict, Time now);
  void on_registration(const msg::Registration& registration, Time now);
  void on_coordinator(const msg::CoordinatorState& state, Time now);
  void on_ledger(const msg::LedgerPage& page, Time now);
  void on_command(const msg::Command& command, Time now);
  void on_robot_report(const msg::Feedback& feedback, Time now);
  /// Ground truth is the reference for positions and contacts, and shows which robots were disturbed.
  void on_truth(const msg::GroundTruth& truth, Time now);
  /// The world state is the reference if no ground truth is received.
  void on_world_state(const msg::WorldState& world, Time now);
  /// Names the cause of a disturbance. Without ground truth it is also the evidence that there was one.
  void on_disturbance(const msg::Disturbance& disturbance, Time now);
  /// The operator attests that a silent robot is not on the floor.
  void on_attestation(const msg::AbsenceAttestation& attestation, Time now);
  void on_order(const msg::Order& order, Time now);
  void on_order_answer(const msg::OrderAnswer& answer, Time now);
  /// The memory of a coordinator or an agent.
  void on_order_memory(const msg::OrderMemory& memory, Time now);
  void on_order_status(const msg::OrderStatus& status, Time now);
  /// A message from a process with different rules was refused.
  void on_refused() { ++totals_.refused; }
  /// Advances the time, also when there are no messages.
  void advance(Time now) { now_ = std::max(now_, now); }

  AuditTotals totals() const;
  /// Calls back for each violation as it is found.
  void on_violation(std::function<void(const Violation&)> callback) { on_violation_ = std::move(callback); }

 private:
  /// What is known about one epoch.
  struct EpochRecord {
    std::uint32_t granter = 0;
    Incarnation granter_incarnation = 0;
    std::int64_t first_grant_ns = kNever;  ///< upper bound
    bool is_reported = false;
    Incarnation page_incarnation = 0;  ///< incarnation of the coordinator whose pages count
  };
  /// What had been proven about a version before the current message.
  struct Evidence {
    std::int64_t alive_until_ns, executed_until_ns;
    bool was_executed;
    bool operator==(const Evidence&) const = default;
  };
  /// The latest position of one robot in the reference that has not yet been compared with feedback.
  struct Observation {
    std::int64_t at_ns = kNever;
    double x = 0, y = 0;
    double reference_error_m = 0;  ///< according to ground truth
  };
  /// A displacement that vision shows.
  struct SeenDisplacement {
    /// The robot has been out of place in all observations since this time.
    std::int64_t since_ns = kNever;
    bool is_reported = false;  ///< ensures that it is reported only once
    /// The robot has been in place in all observations since this time; kNever: unknown.
    std::int64_t in_place_since_ns = kNever;
  };

  void report(AuditRule rule, RobotId robot, const KnownVersion* known, Epoch epoch, std::string detail);
  void report(Violation violation);
  AuditedRobot* robot_of(std::uint32_t robot, const msg::Header& header);
  std::size_t index_of(const AuditedRobot& robot) const {
    return static_cast<std::size_t>(&robot - robots_.data());
  }
  /// Topics whose messages each sender numbers separately.
  enum Kind : std::uint8_t {
    kProposalKind,
    kVerdictKind,
    kRegistrationKind,
    kCoordinatorKind,
    kLedgerKind,
    kCommandKind,
    kRobotReportKind,
    kTruthKind,
    kWorldKind,
    kOrderAnswerKind,
    kOrderMemoryKind,
    kOrderStatusKind
  };
  static constexpr std::uint64_t channel_of(Kind kind, std::uint32_t key) {
    return static_cast<std::uint64_t>(kind) << 32 | key;
  }
  Reception trace(Kind kind, std::uint32_t key, const msg::Header& header);
  /// Whether times of an agent or a coordinator can be compared. Times of the auditor's clock always can;
  /// times of the sender's clock only until it was set back.
  bool are_times_comparable(const msg::Header& header) const {
    return input_.is_complete || stamps_.tell_order(header.sender(), header.incarnation());
  }
  /// An upper bound of the time at which a coordinator sent a message. It is by the auditor's clock if the
  /// auditor receives every message. Otherwise it is by the coordinator's clock, which orders the
  /// coordinator's messages exactly.
  std::int64_t granter_time_ns(const msg::Header& header, const Reception& reception) const;
  /// Stores the version's content and returns its record; nullptr if the content is invalid.
  KnownVersion* store(AuditedRobot& robot, const msg::Version& version);
  EpochRecord& epoch_record(Epoch epoch);

  bool is_known_to_be_displaced(const AuditedRobot& robot) const;

  // Coverage.
  /// Something shows that robots may move. From then on, silence counts once every robot has been heard, but
  /// at the latest after a second.
  void begin_run();
  void hear_robot_report(const AuditedRobot& robot, VersionNumber executing, const Reception& reception);
  void use_reference(AuditReference reference);
  bool has_ground_truth() const;
  Coverage coverage() const;

  // Grants.
  void decide(AuditedRobot& robot, ProposalRecord& proposal, Epoch epoch, VersionNumber granted);
  void check_grant(AuditedRobot& robot, KnownVersion& known, const msg::Verdict& verdict);
  /// Passes a grant that moves a robot to the audit of orders.
  void judge_order(const KnownVersion& known, const msg::Verdict& verdict);
  /// The content of a version's base; nullptr if it was not received. A restarted agent may reuse numbers of
  /// versions that its predecessor proposed without success.
  const KnownVersion* base_of(const AuditedRobot& robot, const KnownVersion& known) const;
  void check_content(const AuditedRobot& robot, KnownVersion& known);
  /// The checks that depend on the version's base.
  void check_against_base(const AuditedRobot& robot, KnownVersion& known);
  void check_limits(const AuditedRobot& robot, const KnownVersion& known);
  void check_field(const AuditedRobot& robot, const KnownVersion& known);
  void check_obstacles(const AuditedRobot& robot, const KnownVersion& known);
  void check_obstacle(const AuditedRobot& robot, const KnownVersion& known, const AuditShape& obstacle,
                      const Shape& shape, bool is_map);
  double distance_of_base_m(const KnownVersion& base, const AuditShape& obstacle, bool is_map,
                            double required_m) const;
  /// Required distance of the robot's centre from the edge of an obstacle.
  double required_separation_m(const KnownVersion& known) const {
    return scenario_.radius_m + scenario_.margin_m + known.version.inflation_m();
  }
  void check_base(const AuditedRobot& robot, const KnownVersion& known);
  void check_granting_epoch(const AuditedRobot& robot, const KnownVersion& known,
                            const msg::Verdict& verdict);
  void check_forwarded(AuditedRobot& robot, VersionNumber number);
  void check_ledger_page(const msg::LedgerPage& page);
  /// Learns which versions the ledger contained at the time of the page.
  void use_ledger_page(const msg::LedgerPage& page);
  /// The proposal that a verdict answers; nullptr if it was not received.
  ProposalRecord* answered_proposal(AuditedRobot& robot, const msg::Verdict& verdict) const;

  // Facts.
  void check_report_order(const AuditedRobot& robot, const msg::Feedback& feedback,
                          const Reception& reception);
  void check_switch(const AuditedRobot& robot, const KnownVersion& to, const msg::Feedback& feedback);
  void check_sent(AuditedRobot& robot, KnownVersion& executing);
  void check_tracking(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback,
                      const Reception& reception);
  void check_own_stop(const AuditedRobot& robot, const KnownVersion& own_stop, std::int64_t lead_ns);
  void check_obeyed_epochs(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback,
                           const Reception& reception);
  void check_registration(AuditedRobot& robot, const KnownVersion& executing, const msg::Feedback& feedback);
  /// Whether the robot certainly sent the fact after its agent had sent the latest registration.
  bool is_after_registration(const AuditedRobot& robot, const msg::Feedback& feedback,
                             const Reception& reception) const;
  bool is_clock_sound(const msg::Feedback& feedback, const Reception& reception) const;
  void exclude(AuditedRobot& robot, const AuditedRobot::ReceivedReport& robot_report,
               const Reception& reception, std::int64_t now_ns);

  // Positions and contacts.
  void check_position(AuditedRobot& robot, const msg::Feedback& feedback, const Reception& reception);
  void check_true_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                           std::int64_t at_ns);
  void check_seen_position(const AuditedRobot& robot, const KnownVersion& executed, double error_m,
                           std::int64_t at_ns);
  /// `reported` is the number of contacts in the previous ground truth. If `is_joining`, the auditor joins
  /// the run with this ground truth.
  void check_contacts(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining);
  /// `reported` is the number of crashes of moving robots in the previous ground truth.
  void check_crashes(const msg::GroundTruth& truth, std::uint64_t reported, bool is_joining);
  /// Whether everything that may excuse a contact of this robot was received. `apart_ns` is the last time at
  /// which vision saw the robot apart from what it touches.
  bool are_excuses_known(std::optional<std::size_t> robot, std::int64_t apart_ns = kAlways) const;
  /// Whether a contact is excused; if so, it is counted. nullopt means an obstacle.
  bool is_excused_contact(RobotId first, std::optional<RobotId> second, Time at,
                          std::int64_t apart_ns = kAlways);
  void record_positions(const msg::GroundTruth& truth);
  void record_sights(const msg::WorldState& world);
  /// Makes vision the reference once it has shown robots for a while without any ground truth being received.
  /// Returns whether it is.
  bool fall_back_to_vision();
  void check_sights(const msg::WorldState& world);
  /// Distance of a position from the version that the robot executes, as far as is known; infinite if nothing
  /// is known.
  double seen_error_m(std::size_t index, const Vec2& position_m, std::int64_t at_ns) const;
  /// `error_m` is the distance from the place that the robot's version prescribes; up to `allowance_m` of it
  /// may be an observation error.
  ObservedRobot observed_robot(std::size_t robot, const Vec2& position_m, double speed_mps, double error_m,
                               double allowance_m) const;
  /// The version that the robot was executing at a time by its clock, as far as is known.
  static const KnownVersion* executed_at(const AuditedRobot& robot, VersionNumber latest, std::int64_t at_ns);
  /// nullopt if the robot is not on the roster.
  std::optional<std::size_t> roster_index(RobotId robot) const;

  // Pairs.
  /// `before` is the evidence for the robot's recent versions before the current fact.
  void check_pairs(const AuditedRobot& robot, const std::vector<Evidence>& before);
  void check_new_pairs(AuditedRobot& robot, KnownVersion& known);
  /// The epoch whose ledger provably contained both versions at the same time. 0 if both were provably
  /// executed at the same time. nullopt if neither is proven.
  std::optional<Epoch> common_epoch(const KnownVersion& a, const Evidence& a_evidence, const KnownVersion& b,
                                    const Evidence& b_evidence) const;
  /// Whether `granted` was checked against `other` when it was granted, assuming that the ledger contained
  /// both at the same time.
  bool was_checked_against(const KnownVersion& granted, const KnownVersion& other) const;
  /// Whether the two robots' times can be compared.
  bool are_clocks_comparable(std::size_t a, std::size_t b) const;
  void check_pair(const AuditedRobot& ra, const KnownVersion& a, const AuditedRobot& rb,
                  const KnownVersion& b, Epoch epoch);
  /// nullopt if the version's base was not received.
  std::optional<bool> is_excused(const AuditedRobot& robot, const KnownVersion& later,
                                 const KnownVersion& other, double distance_m) const;
  /// A cheap necessary condition for a conflict: the new evidence for `mine` can complete the proof that both
  /// were held at the same time, and the two are close enough to conflict.
  bool may_conflict(const LiveVersion& mine, const Evidence& before, const LiveVersion& theirs) const;
  double min_separation_m(const KnownVersion& a, const KnownVersion& b) const;
  static Evidence evidence_of(const KnownVersion& known);

  Scenario scenario_;
  std::vector<AuditShape> obstacles_;  // parallel to scenario_.obstacles
  AuditInput input_;
  double tracking_bound_m_;
  std::int64_t clock_bound_ns_;
  double sight_allowance_m_;
  ComparableStamps stamps_;   ///< stamps of agents and coordinators
  MessageTrace trace_;        ///< messages of robots, coordinators and the reference
  MessageTrace agent_trace_;  ///< messages of agents
  Time now_{};
  std::optional<Time> motion_sign_at_, begun_at_;  ///< when something first showed that robots may move
  ReceptionCoverage report_coverage_;              ///< facts of all robots
  std::optional<ReceptionCoverage> reference_coverage_;
  std::optional<Time> first_sight_at_;
  std::vector<AuditedRobot> robots_;                     ///< sorted by id
  std::vector<BoundingDisc> bounds_;                     ///< parallel to robots_
  std::vector<std::vector<LiveVersion>> live_versions_;  ///< parallel to robots_
  double max_inflation_m_ = 0;                           ///< maximum over all versions received so far
  std::vector<bool> has_sound_clock_;
  std::vector<Observation> observations_;
  std::vector<Sight> sights_;                           ///< parallel to robots_
  std::vector<SeenDisplacement> seen_displacements_;    ///< parallel to robots_
  std::vector<std::optional<ObservedRobot>> observed_;  ///< last observed on the floor; parallel to robots_
  SeenContacts seen_contacts_;
  std::vector<RobotId> named_displaced_;  // robots named as displaced by the coordinator that grants
  bool are_contacts_unknown_ = false;     // it is unknown which robots pushed which
  Disturbances disturbances_;
  /// Number of excused contacts, by cause and robots.
  std::map<std::tuple<std::string_view, RobotId, std::optional<RobotId>>, std::uint64_t> excused_;
  std::vector<std::size_t> index_;  ///< indexed by id; robots_.size(): not on the roster
  std::map<Epoch, EpochRecord> epochs_;
  Epoch newest_epoch_ = 0;  ///< newest epoch that a coordinator has announced
  struct AgentStream {
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };
  std::map<std::uint32_t, std::vector<AgentStream>> agent_epochs_;
  std::map<std::uint64_t, msg::GroundTruth> truths_;  ///< the latest counters of each simulator incarnation
  std::vector<Evidence> earlier_evidence_;
  std::vector<LiveVersion> changed_;
  std::vector<VersionNumber> page_numbers_;
  OrderAudit orders_;
  AuditTotals totals_;
  std::function<void(const Violation&)> on_violation_;
};

/// Subscribes the auditor to a bus. The auditor must outlive the bus's last callback.
void listen(Bus& bus, const Scenario& scenario, Auditor& auditor);
/// Makes a bus that is used for nothing else refuse messages from processes with different rules
/// (PROTOCOL.md, "The same rules"); the auditor counts them. In other processes RulesExchange does this.
void refuse_other_rules(Bus& bus, const Scenario& scenario, Auditor& auditor);

}  // namespace sidestep
