// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include "common/messaging/senders.hpp"
#include "coordinator/ledger_pages.hpp"

namespace sidestep {
namespace {

// A standby announces itself every kStandbyAnnouncePeriod heartbeat periods.
constexpr int kStandbyAnnouncePeriod = 10;

}  // namespace

CoordinatorNode::CoordinatorNode(Bus& bus, const Scenario& scenario, const CoordinatorIdentity& self,
                                 bool is_standby)
    : bus_(bus),
      self_(self),
      cycle_(scenario.cycle),
      failover_(self, is_standby, bus.now()),
      coordinator_(floor_rules(scenario), roster_of(scenario), failover_.epoch()) {
  state_writer_ = bus_.advertise(topics::kCoordinator);
  ledger_writer_ = bus_.advertise(topics::kLedger);
  for (const RobotSpec& robot : scenario.robots) {
    verdict_writers_.emplace(robot.id, bus_.advertise(topics::kVerdict, robot.id));
    bus_.subscribe(topics::kFeedback, robot.id,
                   [this](const msg::Feedback& feedback) { on_feedback(feedback); });
  }
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& state) {
    failover_.on_coordinator_state(state, bus_.now());
    apply_epoch();
  });
  bus_.subscribe(topics::kRegistration,
                 [this](const msg::Registration& registration) { on_registration(registration); });
  bus_.subscribe(topics::kProposal, [this](const msg::Proposal& proposal) { on_proposal(proposal); });
  update_failover();
  publish_state_periodically();
  publish_ledger();
}

template <typename Message>
void CoordinatorNode::publish(Writer<Message>& writer, Message& message) {
  message.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number);
  message.header().incarnation(self_.incarnation);
  writer.publish(message, bus_.now());
}

template <typename Message>
void CoordinatorNode::observe_epoch(const Message& message, Epoch epoch) {
  if (message.header().sender() != message.robot() || !coordinator_.ledger().has_robot(message.robot()))
    return;
  failover_.on_obeyed_epoch(epoch, coordinator_.is_granting(), bus_.now());
  apply_epoch();
}

void CoordinatorNode::on_registration(const msg::Registration& registration) {
  observe_epoch(registration, registration.epoch());
  const bool was_granting = coordinator_.is_granting();
  if (auto answer = coordinator_.on_registration(registration)) {
    publish(verdict_writers_.at(answer->robot()), *answer);
  }
  if (coordinator_.is_granting() != was_granting) publish_state();
}

void CoordinatorNode::on_feedback(const msg::Feedback& feedback) {
  observe_epoch(feedback, feedback.obeyed_epoch());
  coordinator_.on_feedback(feedback);
  if (!coordinator_.is_contradicted()) return;
  failover_.begin_epoch(bus_.now());
  apply_epoch();
}

void CoordinatorNode::on_proposal(const msg::Proposal& proposal) {
  observe_epoch(proposal, proposal.epoch());
  if (auto verdict = coordinator_.on_proposal(proposal))
    publish(verdict_writers_.at(verdict->robot()), *verdict);
}

void CoordinatorNode::apply_epoch() {
  if (failover_.epoch() == coordinator_.epoch()) return;
  coordinator_.begin_epoch(failover_.epoch());
  publish_state();
}

void CoordinatorNode::update_failover() {
  bus_.at(bus_.now() + Failover::kUpdatePeriod, [this] { update_failover(); });
  failover_.update(bus_.now());
  apply_epoch();
}

void CoordinatorNode::publish_state() {
  auto state = coordinator_.state();
  state.coordinator(self_.number);
  state.invalid(state.invalid() + failover_.invalid());
  publish(state_writer_, state);
}

void CoordinatorNode::publish_state_periodically() {
  bus_.at(bus_.now() + Failover::kHeartbeatPeriod, [this] { publish_state_periodically(); });
  if (coordinator_.is_active() || standby_periods_++ % kStandbyAnnouncePeriod == 0) publish_state();
}

void CoordinatorNode::publish_ledger() {
  bus_.at(bus_.now() + cycle_, [this] { publish_ledger(); });
  if (!coordinator_.is_granting()) return;
  for (msg::LedgerPage& page : ledger_pages(coordinator_.ledger(), coordinator_.epoch()))
    publish(ledger_writer_, page);
}

}  // namespace sidestep
