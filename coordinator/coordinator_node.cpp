// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include <utility>

#include "common/messaging/senders.hpp"

namespace sidestep {
namespace {

constexpr Duration kSignOfLife{50'000'000};

std::vector<RobotId> roster_of(const Scenario& scenario) {
  std::vector<RobotId> roster;
  for (const RobotSpec& robot : scenario.robots) roster.push_back(robot.id);
  return roster;
}

}  // namespace

CoordinatorNode::CoordinatorNode(Bus& bus, const Scenario& scenario, Incarnation incarnation)
    : bus_(bus),
      incarnation_(incarnation),
      cycle_(scenario.cycle),
      // Its life is its epoch: a coordinator that starts later has a higher one.
      coordinator_(floor_rules(scenario), roster_of(scenario), incarnation) {
  state_writer_ = bus_.advertise(topics::kCoordinator);
  ledger_writer_ = bus_.advertise(topics::kLedger);
  for (const RobotSpec& robot : scenario.robots) {
    verdict_writers_.emplace(robot.id, bus_.advertise(topics::kVerdict, robot.id));
    bus_.subscribe(topics::kFeedback, robot.id, std::function([this](const msg::Feedback& feedback) {
                     coordinator_.on_feedback(feedback);
                   }));
  }
  bus_.subscribe(topics::kCoordinator, std::function([this](const msg::CoordinatorState& state) {
                   coordinator_.on_coordinator_state(state);
                 }));
  bus_.subscribe(topics::kRegistration, std::function([this](const msg::Registration& registration) {
                   coordinator_.on_registration(registration);
                   publish_state_if_changed();
                 }));
  bus_.subscribe(topics::kProposal, std::function([this](const msg::Proposal& proposal) {
                   if (auto verdict = coordinator_.on_proposal(proposal)) {
                     publish(verdict_writers_.at(verdict->robot()), *verdict);
                   }
                 }));
  publish_state();
  publish_ledger();
}

template <typename Message>
void CoordinatorNode::publish(Writer<Message>& writer, Message& message) {
  message.head().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  message.head().incarnation(incarnation_);
  writer.publish(message, bus_.now());
}

void CoordinatorNode::publish_state() {
  bus_.at(bus_.now() + kSignOfLife, [this] { publish_state(); });
  if (coordinator_.is_superseded()) {
    if (auto callback = std::exchange(on_superseded_, nullptr)) callback();
    return;
  }
  auto state = coordinator_.state();
  publish(state_writer_, state);
}

void CoordinatorNode::publish_state_if_changed() {
  if (coordinator_.is_granting() == was_granting_) return;
  was_granting_ = coordinator_.is_granting();
  auto state = coordinator_.state();
  publish(state_writer_, state);
}

void CoordinatorNode::publish_ledger() {
  bus_.at(bus_.now() + cycle_, [this] { publish_ledger(); });
  if (!coordinator_.is_granting()) return;
  for (std::size_t i = 0; i < coordinator_.page_count(); ++i) {
    auto page = coordinator_.page(i);
    publish(ledger_writer_, page);
  }
}

}  // namespace sidestep
