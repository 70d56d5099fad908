// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/protocol/drop_counters.hpp"
#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"
#include "coordinator/displaced_robots.hpp"
#include "coordinator/ledger.hpp"

namespace sidestep {

/// The only place where versions are compared: registration, verdicts and the ledger of one epoch. What it
/// grants depends on no clock; `now` only shows which robots have fallen silent. Messages may be late,
/// repeated or wrong; an invalid one changes nothing.
class Coordinator {
 public:
  /// In epoch 0 the coordinator stands by and answers no messages. `max_clock_difference`: of two of the
  /// clocks of robots, cameras and this coordinator. `fact_period`: at which robots report facts.
  Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch,
              Duration max_clock_difference = sidestep::max_clock_difference(SafetyBudget{}.clock_bound_s),
              Duration fact_period = {});

  /// Clears all state and begins an epoch, or stands by if `epoch` is 0.
  void begin_epoch(Epoch epoch);

  /// The answer to a proposal. nullopt while standing by, or if the robot is not on the roster.
  [[nodiscard]] std::optional<Verdict> on_proposal(const Proposal& proposal);
  /// The answer to a registration, with proposal_number 0 and REASON_GRANTED if the agent is registered now;
  /// nullopt as for on_proposal().
  std::optional<Verdict> on_registration(const Registration& registration);
  /// A fact from a robot. False if it contradicts the ledger, so that the robot is quarantined: until it is
  /// lifted or a new agent registers it, nothing is granted to it.
  bool on_feedback(const Feedback& feedback, Time now);
  /// Where vision sees the robots. Nothing is granted to displaced robots. `is_whole`: no observation of the
  /// world state was dropped. One of which any is dropped or cannot be compared does not count as watching.
  void on_world(std::span<const RobotObservation> robots, Time now, bool is_whole = true);
  /// The operator attests that a robot is not on the floor, for this epoch. False unless the coordinator
  /// awaits the robot's registration.
  bool on_attestation(RobotId robot);

  /// Nothing is granted to a held robot, also in later epochs, so that it stops as it may already do.
  /// Initially none is held.
  void set_held(RobotId robot, bool is_held) { held_[robot] = is_held; }

  /// This coordinator's clock was set back: what it remembers of times by this clock, and of observations
  /// that it accepted by it, is void.
  void forget_times();

  bool is_active() const { return epoch_ != 0; }
  /// False until every robot of the roster has registered, or its absence is attested.
  bool is_granting() const { return is_active() && unregistered_count_ == 0; }
  Epoch epoch() const { return epoch_; }
  const Ledger& ledger() const { return ledger_; }
  const DisplacedRobots& displaced() const { return displaced_; }
  /// A robot that should be in motion is silent if no fact has arrived for kMaxSilence, for kMissedFacts
  /// periods, or for twice the longest gap of late, so that a slow network does not silence robots. So is one
  /// of which all versions begin later than that.
  bool is_silent(RobotId robot) const { return records_[robot].silent; }
  static constexpr Duration kMaxSilence{50'000'000};
  static constexpr int kMissedFacts = 3;
  /// Whether any robot is displaced or silent.
  bool has_uncontrolled_robots() const { return displaced_.any() || silent_count_ > 0; }

  msg::CoordinatorState state() const;
  /// Messages that were not used, in all epochs.
  const DropCounters& drops() const { return drops_; }

 private:
  static constexpr std::size_t kVerdictHistory = 8;

  /// State of one robot's agent.
  struct Record {
    bool registered = false;
    bool attested = false;  // as absent, instead of its registration
    bool silent = false;
    std::optional<Time> heard_at;  // when the last fact arrived
    Duration longest_gap{0};       // between facts lately
    Incarnation incarnation = 0;
    Incarnation contradicted_under = 0;  // latest agent that the robot obeyed when it contradicted the ledger
    VersionNumber newest_number = 0;     // highest version number proposed so far
    std::array<Verdict, kVerdictHistory> verdicts;
    std::uint64_t verdict_count = 0;  // verdicts in this incarnation
  };

  Record& record_of(RobotId robot) { return records_[robot]; }
  msg::Reason register_agent(const Registration& registration);
  /// Whether an agent's registration ends its robot's quarantine.
  bool ends_quarantine(const Registration& registration, const Record& record) const;
  const Verdict* find_verdict(const Record& record, VersionNumber proposal_number) const;
  void decide(const Proposal& proposal, Record& record, Verdict& verdict);
  msg::Reason refusal_reason(const Proposal& proposal, const Record& record) const;
  void find_silent(Time now);
  /// Why nothing is granted to a registered robot, or REASON_GRANTED.
  msg::Reason suspension_reason(RobotId robot) const;

  Ledger ledger_;
  DisplacedRobots displaced_;
  Duration max_clock_difference_, max_silence_;
  Time watched_until_{};  // time of the latest observation of a world state that was compared as a whole
  Epoch epoch_;
  std::size_t unregistered_count_, silent_count_ = 0;
  std::vector<Record> records_;  // by robot
  std::vector<bool> held_;       // by robot
  std::uint64_t proposals_ = 0, grants_ = 0, denials_ = 0;
  DropCounters drops_;
};

}  // namespace sidestep
