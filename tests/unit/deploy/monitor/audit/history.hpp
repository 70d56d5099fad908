// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "deploy/monitor/audit/auditor.hpp"

namespace sidestep {

using AuditedMessage = std::variant<msg::Proposal, msg::Verdict, msg::Registration, msg::CoordinatorState,
                                    msg::LedgerPage, msg::Command, msg::Feedback, msg::GroundTruth>;

struct HeardMessage {
  Time at;
  AuditedMessage message;
};

/// What was said in a run, to be heard by an auditor as it was, or after somebody has tampered with it.
struct History {
  Scenario scenario;
  std::vector<HeardMessage> messages;

  /// All messages of one type, in order, with their times.
  template <typename Message>
  void each(const std::function<void(Message&, Time)>& use) {
    for (HeardMessage& heard : messages) {
      if (auto* message = std::get_if<Message>(&heard.message)) use(*message, heard.at);
    }
  }
  template <typename Message>
  void remove_if(const std::function<bool(const Message&)>& is_gone) {
    std::erase_if(messages, [&](const HeardMessage& heard) {
      const auto* message = std::get_if<Message>(&heard.message);
      return message && is_gone(*message);
    });
  }
  /// From then on ground truth says that a hand has moved this robot then.
  void push(RobotId robot, Time at);
  /// Every mention of a version in any message.
  void each_mention(RobotId robot, VersionNumber number, const std::function<void(msg::Version&)>& use);
  /// Every version in any message.
  void each_version(const std::function<void(msg::Version&)>& use);
};

/// What the system says in a scenario for so long; the same for the same seed.
History history_of(const Scenario& scenario, std::uint64_t seed, Duration duration);

AuditTotals audit_of(const History& history, const AuditTrace& hearing);

/// What a listener hears who joins late, and whose messages are lost, doubled, and late by up to 20 ms.
History badly_heard(const History& history, std::uint64_t seed, double loss, Duration joined_after);

/// The violations that were kept, a line each.
std::string lines(const AuditTotals& totals);

}  // namespace sidestep
