// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/audit/history.hpp"

#include <algorithm>

#include "common/config/shared_rules.hpp"

namespace sidestep {

void MessageHistory::each_version(const std::function<void(msg::Version&)>& use) {
  for (ReceivedMessage& received : messages) {
    if (auto* proposal = std::get_if<msg::Proposal>(&received.message)) {
      for (std::size_t i = 0; i < proposal->candidate_count(); ++i) use(proposal->candidates()[i]);
    } else if (auto* registration = std::get_if<msg::Registration>(&received.message)) {
      for (std::size_t i = 0; i < registration->version_count(); ++i) use(registration->versions()[i]);
    } else if (auto* page = std::get_if<msg::LedgerPage>(&received.message)) {
      for (msg::Version& version : page->versions()) use(version);
    } else if (auto* command = std::get_if<msg::Command>(&received.message)) {
      if (command->has_version()) use(command->version());
    } else if (auto* feedback = std::get_if<msg::Feedback>(&received.message)) {
      use(feedback->executing());
    }
  }
}

void MessageHistory::push(RobotId pushed_robot, Time at) {
  each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time received_at) {
    if (received_at < at) return;
    for (msg::TrueRobotState& robot : truth.robots()) {
      if (robot.robot() == pushed_robot) robot.disturbance_end_ns(to_ns(at));
    }
  });
  msg::Disturbance push;
  push.robot(pushed_robot);
  push.disturbance_kind(msg::DisturbanceKind::DISTURBANCE_PUSH);
  const auto place = std::ranges::find_if(messages, [&](const auto& received) { return received.at >= at; });
  messages.insert(place, {at, push});
}

void MessageHistory::touch(RobotId first, std::optional<RobotId> second, Time at) {
  each<msg::GroundTruth>([&](msg::GroundTruth& truth, Time received_at) {
    if (received_at < at) return;
    msg::ContactPair& contact = truth.recent_contacts()[truth.contacts() % msg::MAX_CONTACTS];
    contact.first(first);
    contact.second(second.value_or(msg::NO_ROBOT));
    truth.contacts(truth.contacts() + 1);
  });
}

void MessageHistory::for_each_copy(RobotId robot, VersionNumber number,
                                   const std::function<void(msg::Version&)>& use) {
  each_version([&](msg::Version& version) {
    if (version.robot() == robot && version.version_number() == number) use(version);
  });
}

HistoryRecorder::HistoryRecorder(SimSystem& system, MessageHistory& history) : bus_(system.network()) {
  bus_.become_observer();
  bus_.trust_first_senders();
  bus_.use_rules(SharedRules(history.scenario).fingerprint(), [](const TopicInfo&, const msg::Header&) {});
  const auto collect = [this, &history]<typename Message>(const Topic<Message>& topic, RobotId robot) {
    bus_.subscribe<Message>(topic, robot, [this, &history](const Message& message) {
      history.messages.push_back({bus_.now(), message});
    });
  };
  collect(topics::kProposal, 0);
  collect(topics::kRegistration, 0);
  collect(topics::kCoordinator, 0);
  collect(topics::kLedger, 0);
  collect(topics::kTruth, 0);
  collect(topics::kWorld, 0);
  collect(topics::kDisturbance, 0);
  collect(topics::kAttestation, 0);
  collect(topics::kOrder, 0);
  collect(topics::kOrderAnswer, 0);
  collect(topics::kOrderMemory, 0);
  collect(topics::kAgentOrders, 0);
  collect(topics::kOrderStatus, 0);
  for (const RobotSpec& robot : history.scenario.robots) {
    collect(topics::kVerdict, robot.id);
    collect(topics::kCommand, robot.id);
    collect(topics::kFeedback, robot.id);
  }
}

MessageHistory history_of(const Scenario& scenario, std::uint64_t seed, Duration duration) {
  return history_of(scenario, seed, [=](SimSystem& system) { system.run_for(duration); });
}

MessageHistory history_of(const Scenario& scenario, std::uint64_t seed,
                          const std::function<void(SimSystem&)>& act) {
  MessageHistory history{scenario, {}};
  SimSystem system(scenario, seed);
  const HistoryRecorder recorder(system, history);
  act(system);
  return history;
}

namespace {

struct Deliver {
  Auditor& auditor;
  Time at;
  void operator()(const msg::Proposal& m) const { auditor.on_proposal(m, at); }
  void operator()(const msg::Verdict& m) const { auditor.on_verdict(m, at); }
  void operator()(const msg::Registration& m) const { auditor.on_registration(m, at); }
  void operator()(const msg::CoordinatorState& m) const { auditor.on_coordinator(m, at); }
  void operator()(const msg::LedgerPage& m) const { auditor.on_ledger(m, at); }
  void operator()(const msg::Command& m) const { auditor.on_command(m, at); }
  void operator()(const msg::Feedback& m) const { auditor.on_robot_report(m, at); }
  void operator()(const msg::GroundTruth& m) const { auditor.on_truth(m, at); }
  void operator()(const msg::WorldState& m) const { auditor.on_world_state(m, at); }
  void operator()(const msg::Disturbance& m) const { auditor.on_disturbance(m, at); }
  void operator()(const msg::AbsenceAttestation& m) const { auditor.on_attestation(m, at); }
  void operator()(const msg::Order& m) const { auditor.on_order(m, at); }
  void operator()(const msg::OrderAnswer& m) const { auditor.on_order_answer(m, at); }
  void operator()(const msg::OrderMemory& m) const { auditor.on_order_memory(m, at); }
  void operator()(const msg::OrderStatus& m) const { auditor.on_order_status(m, at); }
};

}  // namespace

AuditTotals audit_of(const MessageHistory& history, const AuditInput& input) {
  return audit_of(history, input, nullptr);
}

AuditTotals audit_of(const MessageHistory& history, const AuditInput& input,
                     const std::function<void(const Violation&)>& on_violation) {
  Auditor auditor(history.scenario, input);
  auditor.on_violation(on_violation);
  for (const ReceivedMessage& received : history.messages)
    std::visit(Deliver{auditor, received.at}, received.message);
  return auditor.totals();
}

AuditTotals audit_of(const Scenario& scenario, const std::vector<Delivery>& deliveries,
                     const AuditInput& input) {
  Auditor auditor(scenario, input);
  for (const Delivery& delivery : deliveries) std::visit(Deliver{auditor, delivery.at}, *delivery.message);
  return auditor.totals();
}

MessageHistory degraded(const MessageHistory& history, std::uint64_t seed, double loss,
                        Duration joined_after) {
  Rng rng(seed);
  MessageHistory result{history.scenario, {}};
  const Time from = history.messages.front().at + joined_after;
  for (const ReceivedMessage& message : history.messages) {
    for (int copy = 0; copy < 2; ++copy) {
      if (copy == 1 && !rng.chance(0.1)) continue;
      const double max_delay_s = 0.02 * rng.uniform();
      const Time at = message.at + from_seconds(max_delay_s * rng.uniform());
      if (at >= from && !rng.chance(loss)) result.messages.push_back({at, message.message});
    }
  }
  std::ranges::stable_sort(result.messages, {}, &ReceivedMessage::at);
  return result;
}

std::string lines(const AuditTotals& totals) {
  std::string text;
  for (const Violation& violation : totals.first) text += to_line(violation) + '\n';
  return text;
}

}  // namespace sidestep
