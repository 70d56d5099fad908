// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "coordinator/ledger.hpp"
#include "idl/negotiation.h"
#include "idl/robot.h"

namespace sidestep {

/// The one place where versions are compared: registration, verdicts and the ledger of one epoch. It needs no
/// clock. Every message that reaches it may be late, repeated, wrong or hostile; what it cannot use changes
/// nothing.
class Coordinator {
 public:
  /// Epoch 0: it stands by, and answers nobody.
  Coordinator(const FloorRules& rules, std::vector<RobotId> roster, Epoch epoch);

  /// Forgets everything and begins again: an epoch of its own, or 0 to stand by.
  void begin_epoch(Epoch epoch);

  /// The answer to a proposal; none for one that names no robot of the roster.
  std::optional<msg::Verdict> on_proposal(const msg::Proposal& proposal);
  /// The answer to a registration, with proposal_number 0, REASON_GRANTED where the coordinator knows the
  /// agent now; none for one that names no robot of the roster.
  std::optional<msg::Verdict> on_registration(const msg::Registration& registration);
  /// A fact from a robot.
  void on_feedback(const msg::Feedback& feedback);
  /// A robot has told a fact that cannot be true if the ledger is. Nothing is granted any more: a new epoch
  /// has to begin.
  bool is_contradicted() const { return contradicted_; }

  bool is_active() const { return epoch_ != 0; }
  /// False until every robot of the roster has registered, and once the ledger was contradicted.
  bool is_granting() const { return is_active() && missing_ == 0 && !contradicted_; }
  Epoch epoch() const { return epoch_; }
  const Ledger& ledger() const { return ledger_; }

  msg::CoordinatorState state() const;

 private:
  static constexpr std::size_t kRememberedVerdicts = 8;

  /// What it knows of a robot besides its versions.
  struct Record {
    bool registered = false;
    Incarnation incarnation = 0;
    VersionNumber newest = 0;  // highest version number proposed so far
    std::array<msg::Verdict, kRememberedVerdicts> verdicts;
    std::uint64_t answered = 0;  // how many proposals, in this incarnation
  };

  Record& record_of(RobotId robot) { return records_[robot]; }
  msg::Reason enter(const msg::Registration& registration);
  const msg::Verdict* remembered(const Record& record, std::uint64_t proposal_number) const;
  void rule_on(const msg::Proposal& proposal, Record& record, msg::Verdict& verdict);
  msg::Reason refusal_of(const msg::Proposal& proposal, const Record& record) const;

  Ledger ledger_;
  Epoch epoch_;
  bool contradicted_ = false;
  std::size_t missing_;
  std::vector<Record> records_;  // by robot
  std::uint64_t proposals_ = 0, grants_ = 0, denials_ = 0, invalid_ = 0;
};

}  // namespace sidestep
