// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/protocol/negotiation_messages.hpp"
#include "common/protocol/robot_messages.hpp"
#include "coordinator/ledger.hpp"

namespace sidestep {

/// The only place where versions are compared: registration, verdicts and the ledger of one epoch. It needs
/// no clock. Messages may be late, repeated or wrong; an invalid one changes nothing.
class Coordinator {
 public:
  /// In epoch 0 the coordinator stands by and answers no messages.
  Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch);

  /// Clears all state and begins an epoch, or stands by if `epoch` is 0.
  void begin_epoch(Epoch epoch);

  /// The answer to a proposal. nullopt while standing by, or if the robot is not on the roster.
  [[nodiscard]] std::optional<Verdict> on_proposal(const Proposal& proposal);
  /// The answer to a registration, with proposal_number 0 and REASON_GRANTED if the agent is registered now;
  /// nullopt as for on_proposal().
  std::optional<Verdict> on_registration(const Registration& registration);
  /// A fact from a robot.
  void on_feedback(const Feedback& feedback);
  /// A robot has reported a fact that is inconsistent with the ledger. Nothing is granted until a new epoch
  /// begins.
  bool is_contradicted() const { return contradicted_; }

  bool is_active() const { return epoch_ != 0; }
  /// False until every robot of the roster has registered, and after a contradiction.
  bool is_granting() const { return is_active() && unregistered_count_ == 0 && !contradicted_; }
  Epoch epoch() const { return epoch_; }
  const Ledger& ledger() const { return ledger_; }

  msg::CoordinatorState state() const;

 private:
  static constexpr std::size_t kVerdictHistory = 8;

  /// State of one robot's agent.
  struct Record {
    bool registered = false;
    Incarnation incarnation = 0;
    VersionNumber newest_number = 0;  // highest version number proposed so far
    std::array<Verdict, kVerdictHistory> verdicts;
    std::uint64_t verdict_count = 0;  // verdicts in this incarnation
  };

  Record& record_of(RobotId robot) { return records_[robot]; }
  msg::Reason register_agent(const Registration& registration);
  const Verdict* find_verdict(const Record& record, VersionNumber proposal_number) const;
  void decide(const Proposal& proposal, Record& record, Verdict& verdict);
  msg::Reason refusal_reason(const Proposal& proposal, const Record& record) const;

  Ledger ledger_;
  Epoch epoch_;
  bool contradicted_ = false;
  std::size_t unregistered_count_;
  std::vector<Record> records_;  // by robot
  std::uint64_t proposals_ = 0, grants_ = 0, denials_ = 0, invalid_ = 0;
};

}  // namespace sidestep
