// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/config/scenario.hpp"
#include "common/messaging/bus.hpp"
#include "deploy/monitor/audit/audit_rules.hpp"
#include "deploy/monitor/audit/audited_robot.hpp"
#include "deploy/monitor/audit/disturbances.hpp"
#include "deploy/monitor/audit/message_trace.hpp"

namespace sidestep {

/// How the auditor hears.
struct AuditTrace {
  /// Every message from the start on, at the moment when it is sent; only then is what was never heard
  /// evidence.
  bool is_complete = false;
  /// The fastest of a sender's messages take less than this to the auditor. Not used if is_complete.
  Duration fastest{5'000'000};
};

/// Listens to everything that is said and tells who broke which rule of the safety protocol when. It shares
/// no code with what it judges. It may come late, and miss messages or hear them in another order: then it
/// judges only by what was said and cannot have been said had all rules been kept, and says less, but nothing
/// wrong. Memory is bounded by the roster.
class Auditor {
 public:
  Auditor(const Scenario& scenario, const AuditTrace& hearing);

  void on_proposal(const msg::Proposal& proposal, Time now);
  void on_verdict(const msg::Verdict& verdict, Time now);
  void on_registration(const msg::Registration& registration, Time now);
  void on_coordinator(const msg::CoordinatorState& state, Time now);
  void on_ledger(const msg::LedgerPage& page, Time now);
  void on_command(const msg::Command& command, Time now);
  void on_feedback(const msg::Feedback& feedback, Time now);
  /// Whoever was moved by a hand may touch others, and be where it ought not to be, until it is seen in its
  /// place again.
  void on_truth(const msg::GroundTruth& truth, Time now);

  AuditTotals totals() const;
  /// Calls back for each violation as it is found.
  void on_violation(std::function<void(const Violation&)> callback) { on_violation_ = std::move(callback); }

 private:
  /// What is known of one epoch.
  struct EpochRecord {
    std::uint32_t granter = 0;
    Incarnation granter_life = 0;
    std::int64_t first_grant_ns = kNever;  ///< not after this
    bool is_reported = false;
  };
  struct Before {  ///< what was proven of a version before the message that is being looked at
    std::int64_t alive_until_ns, executed_until_ns;
    bool was_executed;
    bool operator==(const Before&) const = default;
  };
  struct Sight {  ///< of one robot in ground truth
    std::int64_t at_ns = kNever;
    double x = 0, y = 0;
  };

  void report(AuditRule rule, RobotId robot, const Known* known, Epoch epoch, std::string what);
  void report(Violation violation);
  AuditedRobot* robot_of(std::uint32_t robot, const msg::Header& head);
  std::size_t index_of(const AuditedRobot& robot) const {
    return static_cast<std::size_t>(&robot - robots_.data());
  }
  /// Topics whose messages one sender counts separately.
  enum Kind : std::uint8_t {
    kProposalKind,
    kVerdictKind,
    kRegistrationKind,
    kCoordinatorKind,
    kLedgerKind,
    kCommandKind,
    kFeedbackKind,
    kTruthKind
  };
  Heard note(Kind kind, std::uint32_t key, const msg::Header& head);
  /// The version's record with its content; nullptr if that makes no sense.
  Known* learn(AuditedRobot& robot, const msg::Version& version);
  EpochRecord& epoch_record(Epoch epoch);

  // Grants.
  void rule(AuditedRobot& robot, HeardProposal& proposal, Epoch epoch, VersionNumber granted);
  void judge_grant(AuditedRobot& robot, Known& known, const msg::Verdict& verdict);
  void judge_content(const AuditedRobot& robot, const Known& known);
  void judge_limits(const AuditedRobot& robot, const Known& known);
  void judge_floor(const AuditedRobot& robot, const Known& known);
  void judge_base(const AuditedRobot& robot, const Known& known);
  void judge_epoch(const AuditedRobot& robot, const Known& known, const msg::Verdict& verdict);
  void judge_forwarded(AuditedRobot& robot, VersionNumber number);
  void judge_page(const msg::LedgerPage& page);

  // Facts.
  void judge_order(const AuditedRobot& robot, const msg::Feedback& feedback);
  void judge_switch(const AuditedRobot& robot, const Known& to, const msg::Feedback& feedback);
  void judge_origin(AuditedRobot& robot, Known& executing);
  void judge_tracking(AuditedRobot& robot, const Known& executing, const msg::Feedback& feedback,
                      const Heard& heard);
  void judge_own(const AuditedRobot& robot, const Known& own);
  void judge_epochs(AuditedRobot& robot, const Known& executing, const msg::Feedback& feedback,
                    const Heard& heard);
  void judge_place(AuditedRobot& robot, const msg::Feedback& feedback, const Heard& heard);
  /// `before`: contacts that were told of before.
  void judge_contacts(const msg::GroundTruth& truth, std::uint64_t before);
  /// Where everybody is.
  void see(const msg::GroundTruth& truth);
  /// In the roster; nothing for who is not in it.
  std::optional<std::size_t> place_of(RobotId robot) const;
  static void exclude(AuditedRobot& robot, const AuditedRobot::Fact& fact, const Heard& heard,
                      std::int64_t now_ns);
  bool clock_is_sound(const msg::Feedback& feedback, const Heard& heard) const;

  // Pairs.
  /// `before`: of its recent versions, before the fact that is being looked at.
  void judge_pairs_of(const AuditedRobot& robot, const std::vector<Before>& before);
  void judge_new_pairs_of(AuditedRobot& robot, const Known& known);
  /// Whether, and in which epoch's ledger (0: at once, by facts), both were held at one time; nullopt: not
  /// proven.
  std::optional<Epoch> held_together(const Known& a, const Before& a_state, const Known& b,
                                     const Before& b_state) const;
  void judge_pair(const AuditedRobot& ra, const Known& a, const AuditedRobot& rb, const Known& b,
                  Epoch epoch);
  /// nullopt: its base was not heard.
  std::optional<bool> is_excused(const AuditedRobot& robot, const Known& later, const Known& other,
                                 double distance_m) const;
  /// Whether what has just become known of `mine` can be the last that was missing to prove that both were
  /// held at one time, and they lie near enough to each other.
  bool may_matter(const Live& mine, const Before& before, const Live& theirs) const;
  double min_separation_m(const Known& a, const Known& b) const;
  static Before state_of(const Known& known);

  Scenario scenario_;
  AuditTrace how_;
  double tracking_bound_m_;
  std::int64_t clock_bound_ns_;
  MessageTrace hearing_;
  Time now_{};
  std::vector<AuditedRobot> robots_;      ///< ascending by id
  std::vector<Whereabouts> whereabouts_;  ///< as robots_
  std::vector<std::vector<Live>> live_;   ///< as robots_
  double max_inflation_m_ = 0;               ///< that was heard of
  std::vector<bool> has_sound_clock_;
  std::vector<Sight> sights_;
  std::vector<std::optional<Vec2>> places_m_;  ///< in the last truth, as robots_
  Hands hands_;                                ///< only who hears everything judges places
  std::vector<std::size_t> index_;             ///< by id; robots_.size(): not on the roster
  std::map<Epoch, EpochRecord> epochs_;
  struct AgentStream {
    Incarnation incarnation = 0;
    Epoch epoch = 0;
  };
  std::map<std::uint32_t, std::vector<AgentStream>> agent_epochs_;
  std::map<std::uint64_t, msg::GroundTruth> truths_;  ///< last counters of each simulator's life
  std::vector<Before> before_;
  std::vector<Live> changed_;
  std::vector<VersionNumber> page_numbers_;
  AuditTotals totals_;
  std::function<void(const Violation&)> on_violation_;
};

/// Lets the auditor hear a bus from now on; it must outlive the bus's last callback.
void listen(Bus& bus, const Scenario& scenario, Auditor& auditor);

}  // namespace sidestep
