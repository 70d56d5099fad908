// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "common/messaging/sim/bus.hpp"
#include "deploy/audit/auditor.hpp"
#include "deploy/trial/simulate/system/sim_system.hpp"

namespace sidestep {

using AuditedMessage =
    std::variant<msg::Proposal, msg::Verdict, msg::Registration, msg::CoordinatorState, msg::LedgerPage,
                 msg::Command, msg::Feedback, msg::GroundTruth, msg::WorldState, msg::Disturbance,
                 msg::AbsenceAttestation, msg::Order, msg::OrderAnswer, msg::OrderMemory, msg::OrderStatus>;

struct ReceivedMessage {
  Time at;
  AuditedMessage message;
};

/// The messages of a run, to be audited with or without modifications.
struct MessageHistory {
  Scenario scenario;
  std::vector<ReceivedMessage> messages;

  /// Calls back with each message of one type and its time, in order.
  template <typename Message>
  void each(const std::function<void(Message&, Time)>& use) {
    for (ReceivedMessage& received : messages) {
      if (auto* message = std::get_if<Message>(&received.message)) use(*message, received.at);
    }
  }
  template <typename Message>
  void remove_if(const std::function<bool(const Message&)>& is_removed) {
    std::erase_if(messages, [&](const ReceivedMessage& received) {
      const auto* message = std::get_if<Message>(&received.message);
      return message && is_removed(*message);
    });
  }
  /// Adds an operator's announcement of a push of this robot, and lets ground truth report it from `at` on.
  void push(RobotId robot, Time at);
  /// From `at` onwards, ground truth reports one more contact; without a second robot, it is a contact with
  /// an obstacle.
  void touch(RobotId first, std::optional<RobotId> second, Time at);
  /// Visits every copy of this version in any message.
  void for_each_copy(RobotId robot, VersionNumber number, const std::function<void(msg::Version&)>& use);
  /// Visits every version in any message.
  void each_version(const std::function<void(msg::Version&)>& use);
};

/// Collects in memory all messages that an auditor would hear in a system, until the system ends.
class HistoryRecorder {
 public:
  /// `history` must outlive the recorder, and the recorder must not outlive the system.
  HistoryRecorder(SimSystem& system, MessageHistory& history);

 private:
  SimBus bus_;
};

/// The messages of a simulated run of this duration; the same seed gives the same history.
MessageHistory history_of(const Scenario& scenario, std::uint64_t seed, Duration duration);
/// The messages of a run that `act` drives: it may give orders and kill processes.
MessageHistory history_of(const Scenario& scenario, std::uint64_t seed,
                          const std::function<void(SimSystem&)>& act);

AuditTotals audit_of(const MessageHistory& history, const AuditInput& input);
/// Calls back for each violation in the history, including those beyond what the totals keep.
AuditTotals audit_of(const MessageHistory& history, const AuditInput& input,
                     const std::function<void(const Violation&)>& on_violation);

/// One message of a history and the time at which it reaches the auditor.
struct Delivery {
  Time at;
  const AuditedMessage* message = nullptr;
};
AuditTotals audit_of(const Scenario& scenario, const std::vector<Delivery>& deliveries,
                     const AuditInput& input);

/// The history as received by an auditor that joins late, over a network that loses, duplicates and delays
/// messages by up to 20 ms.
MessageHistory degraded(const MessageHistory& history, std::uint64_t seed, double loss,
                        Duration joined_after);

/// The recorded violations, one per line.
std::string lines(const AuditTotals& totals);

}  // namespace sidestep
