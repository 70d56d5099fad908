// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include <fmt/format.h>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/senders.hpp"
#include "coordinator/ledger_pages.hpp"

namespace sidestep {
namespace {

// A standby announces itself every kStandbyAnnouncePeriod heartbeat periods.
constexpr int kStandbyAnnouncePeriod = 10;
// A robot that has been heard of within this time is not absent.
constexpr Duration kSilence{1'000'000'000};
// A world state that is valid later by this coordinator's clock is refused: it would make all others
// outdated.
constexpr Duration kMaxVisionAhead{100'000'000};

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
    bus_.subscribe(topics::kFeedback, robot.id, [this, id = robot.id](const msg::Feedback& message) {
      take(decode(message, id, bus_.now()));
    });
  }
  bus_.subscribe(topics::kCoordinator,
                 [this](const msg::CoordinatorState& message) { take(decode(message, bus_.now())); });
  bus_.subscribe(topics::kRegistration,
                 [this](const msg::Registration& message) { take(decode(message, bus_.now())); });
  bus_.subscribe(topics::kProposal,
                 [this](const msg::Proposal& message) { take(decode(message, bus_.now())); });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& message) { on_world(message); });
  bus_.subscribe(topics::kAttestation,
                 [this](const msg::AbsenceAttestation& message) { on_attestation(message); });
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

template <typename Decoded>
void CoordinatorNode::take(const std::optional<Decoded>& decoded) {
  if (decoded)
    handle(*decoded);
  else
    ++invalid_;
}

void CoordinatorNode::handle(const CoordinatorHeartbeat& heartbeat) {
  failover_.on_heartbeat(heartbeat, bus_.now());
  apply_epoch();
}

void CoordinatorNode::handle(const Registration& registration) {
  observe_epoch(registration.robot, registration.epoch);
  const bool was_granting = coordinator_.is_granting();
  if (const auto verdict = coordinator_.on_registration(registration)) answer(*verdict);
  if (coordinator_.is_granting() != was_granting) publish_state();
}

void CoordinatorNode::handle(const Feedback& feedback) {
  observe_epoch(feedback.robot, feedback.obeyed_epoch);
  if (!feedback.is_absent()) heard_at_[feedback.robot] = bus_.now();
  const bool was_quarantined = coordinator_.ledger().is_quarantined(feedback.robot);
  if (coordinator_.on_feedback(feedback, bus_.now()) || was_quarantined) return;
  report(fmt::format("robot {} is quarantined: it executes version {}, which it was never granted",
                     feedback.robot, feedback.executing.number));
  publish_state();
}

void CoordinatorNode::on_world(const msg::WorldState& message) {
  const Time valid_at = time_from_ns(message.valid_at_ns());
  if (message.header().sender() != static_cast<std::uint32_t>(Sender::kVision) ||
      valid_at > bus_.now() + kMaxVisionAhead) {
    ++invalid_;
    return;
  }
  observations_.clear();
  for (const msg::TrackedRobot& robot : message.robots()) {
    const auto observation = decode(robot, bus_.now());
    if (observation && observation->observed_at <= bus_.now() + Ledger::kMaxClockDifference)
      observations_.push_back(*observation);
    else
      ++invalid_;
  }
  const bool was_uncontrolled = coordinator_.has_uncontrolled_robots();
  coordinator_.on_world(observations_, valid_at, bus_.now());
  // Agents need the latest places at once.
  if (was_uncontrolled || coordinator_.has_uncontrolled_robots()) publish_state();
}

void CoordinatorNode::on_attestation(const msg::AbsenceAttestation& message) {
  const RobotId robot = message.robot();
  if (message.header().sender() != static_cast<std::uint32_t>(Sender::kOperator)) {
    ++invalid_;
    return;
  }
  if (!coordinator_.is_active()) return;
  const auto heard = heard_at_.find(robot);
  if (heard != heard_at_.end() && bus_.now() - heard->second < kSilence) {
    report(fmt::format("robot {} reports that it is on the floor: its attested absence is ignored", robot));
  } else if (coordinator_.on_attestation(robot)) {
    report(fmt::format("an operator attests that robot {} is absent; valid in epoch {}", robot,
                       coordinator_.epoch()));
    publish_state();
  } else {
    report(fmt::format("robot {} is not missing: its attested absence is ignored", robot));
  }
}

void CoordinatorNode::handle(const Proposal& proposal) {
  observe_epoch(proposal.robot, proposal.epoch);
  if (const auto verdict = coordinator_.on_proposal(proposal)) answer(*verdict);
}

void CoordinatorNode::observe_epoch(RobotId robot, Epoch epoch) {
  if (!coordinator_.ledger().has_robot(robot)) return;
  failover_.on_obeyed_epoch(epoch, coordinator_.is_granting(), bus_.now());
  apply_epoch();
}

void CoordinatorNode::answer(const Verdict& verdict) {
  msg::Verdict message = encode(verdict);
  publish(verdict_writers_.at(verdict.robot), message);
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
  state.invalid(state.invalid() + failover_.invalid() + invalid_);
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
