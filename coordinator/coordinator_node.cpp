// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include <algorithm>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/protocol/reason_text.hpp"
#include "common/protocol/senders.hpp"
#include "coordinator/ledger_pages.hpp"
#include "coordinator/publish.hpp"

namespace sidestep {
namespace {

// A standby announces itself every kStandbyAnnouncePeriod heartbeat periods.
constexpr int kStandbyAnnouncePeriod = 10;
// A robot that has been heard within this time is not absent.
constexpr Duration kSilence{1'000'000'000};

}  // namespace

CoordinatorNode::CoordinatorNode(Bus& bus, const FloorSpec& floor, const CoordinatorIdentity& self,
                                 bool is_standby)
    : bus_(bus),
      self_(self),
      cycle_(floor.cycle),
      max_clock_difference_(max_clock_difference(floor.clock_bound_s)),
      failover_(self, is_standby, bus.now(), {roster_of(floor), floor.cycle}),
      coordinator_(floor_rules(floor), roster_of(floor), failover_.epoch(), max_clock_difference_,
                   floor.cycle),
      order_service_(bus, floor, self, coordinator_, events_, [this] { publish_state(); }),
      course_relay_(bus, self, coordinator_, floor.cycle),
      counters_(bus, process_of(self.number), self.incarnation,
                [this](DropCounters& drops) { count_drops(drops); }) {
  state_writer_ = bus_.advertise(topics::kCoordinator);
  ledger_writer_ = bus_.advertise(topics::kLedger);
  for (const RobotSpec& robot : floor.robots) {
    verdict_writers_.emplace(robot.id, bus_.advertise(topics::kVerdict, robot.id));
    bus_.subscribe(topics::kFeedback, robot.id, [this, id = robot.id](const msg::Feedback& message) {
      handle_or_count(decode(message, id, bus_.now()), DropReason::kMalformedFeedback, id);
    });
  }
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& message) {
    handle_or_count(decode(message, bus_.now()), DropReason::kMalformedCoordinatorState);
  });
  bus_.subscribe(topics::kRegistration, [this](const msg::Registration& message) {
    handle_or_count(decode(message, bus_.now()), DropReason::kMalformedRegistration);
  });
  bus_.subscribe(topics::kProposal, [this](const msg::Proposal& message) {
    handle_or_count(decode(message, bus_.now()), DropReason::kMalformedProposal);
  });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& message) { on_world_state(message); });
  bus_.subscribe(topics::kAttestation,
                 [this](const msg::AbsenceAttestation& message) { on_attestation(message); });
  bus_.subscribe(topics::kOrder, [this](const msg::Order& message) { order_service_.on_order(message); });
  for (const auto& memory : {topics::kOrderMemory, topics::kAgentOrders}) {
    bus_.subscribe(memory, [this](const msg::OrderMemory& message) {
      handle_or_count(decode(message, bus_.now()), DropReason::kMalformedOrder);
    });
  }
  bus_.subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& message) {
    handle_or_count(decode(message), DropReason::kMalformedOrder);
  });
  update_failover();
  publish_state_periodically();
  publish_ledger();
  order_service_.announce_periodically();
}

void CoordinatorNode::on_event(LogLevel min_level, OnLogEvent callback) {
  events_.set_listener(min_level, std::move(callback));
  report_role();
}

void CoordinatorNode::report_role() {
  if (failover_.is_active())
    events_.report(LogLevel::kInfo, {}, "begins epoch {}: {}", failover_.epoch(),
                   describe(failover_.cause()));
  else
    events_.report(LogLevel::kInfo, {}, "stands by: {}", describe(failover_.cause()));
}

template <typename Decoded>
void CoordinatorNode::handle_or_count(const std::optional<Decoded>& decoded, DropReason reason,
                                      std::optional<RobotId> robot) {
  if (decoded)
    handle(*decoded);
  else
    drops_.count(reason, robot);
}

void CoordinatorNode::count_drops(DropCounters& drops) const {
  drops.add(drops_);
  drops.add(coordinator_.drops());
  drops.add(order_service_.drops());
  drops.add(course_relay_.drops());
  drops.count(DropReason::kImplausibleEpoch, std::nullopt, failover_.invalid());
  drops.count(DropReason::kFrequentEpoch, std::nullopt, failover_.too_frequent());
}

void CoordinatorNode::handle(const CoordinatorHeartbeat& heartbeat) {
  failover_.on_heartbeat(heartbeat, bus_.now());
  apply_epoch();
  if (!heartbeat.remembers_orders) order_service_.repeat();
}

void CoordinatorNode::handle(const Registration& registration) {
  if (coordinator_.ledger().has_robot(registration.robot))
    failover_.reception().on_registration(registration.robot, bus_.now());
  if (registration.epoch == 0) return;  // epoch 0: the agent knows no coordinator
  observe_epoch(registration.robot, registration.epoch, EpochHolder::kAgent);
  if (registration.asks_for_orders) return order_service_.repeat();
  const bool was_granting = coordinator_.is_granting();
  if (const auto verdict = coordinator_.on_registration(registration)) {
    answer(*verdict);
    report_registration(registration, *verdict);
    if (verdict->reasons.front() == msg::Reason::REASON_GRANTED) order_service_.on_registered(registration);
  }
  if (coordinator_.is_granting() != was_granting) {
    order_service_.update_memory();
    publish_state();
  }
}

void CoordinatorNode::report_registration(const Registration& registration, const Verdict& verdict) const {
  const RobotId robot = registration.robot;
  if (verdict.reasons.front() == msg::Reason::REASON_GRANTED)
    events_.report(LogLevel::kDebug, robot, "robot {} is registered by its agent of incarnation {}", robot,
                   registration.incarnation);
  else
    events_.report(LogLevel::kDebug, robot,
                   "the registration of robot {} by its agent of incarnation {} is refused: {}", robot,
                   registration.incarnation, to_text(verdict.reasons.front()));
}

void CoordinatorNode::handle(const RobotReport& robot_report) {
  observe_epoch(robot_report.robot, robot_report.obeyed_epoch, EpochHolder::kRobot);
  if (!robot_report.is_absent()) heard_at_[robot_report.robot] = bus_.now();
  const bool is_granted = !robot_report.is_off_reference && !robot_report.is_absent();
  if (coordinator_.ledger().has_robot(robot_report.robot))
    failover_.reception().on_robot_report(robot_report.robot, robot_report.executing.number, is_granted,
                                          bus_.now());
  if (robot_report.obeyed_epoch == coordinator_.epoch()) order_service_.on_obeyed(robot_report.robot);
  const bool was_quarantined = coordinator_.ledger().is_quarantined(robot_report.robot);
  if (coordinator_.on_robot_report(robot_report, bus_.now()) || was_quarantined) return;
  events_.report(LogLevel::kWarning, robot_report.robot,
                 "robot {} executes version {}, which it was never granted", robot_report.robot,
                 robot_report.executing.number);
  publish_state();
}

void CoordinatorNode::on_world_state(const msg::WorldState& message) {
  const Time valid_at = time_from_ns(message.valid_at_ns());
  // The farther into the future a world state is dated, the less certain its positions are.
  if (valid_at > bus_.now() + max_vision_lead(max_clock_difference_))
    return drops_.count(DropReason::kFutureWorld);
  failover_.reception().on_vision(bus_.now());
  observations_.clear();
  bool is_whole = true;
  for (const msg::TrackedRobot& robot : message.robots()) {
    if (const auto observation = decode(robot, bus_.now())) {
      observations_.push_back(*observation);
    } else {
      drops_.count(DropReason::kMalformedObservation);
      is_whole = false;
    }
  }
  const bool was_uncontrolled = coordinator_.has_uncontrolled_robots();
  coordinator_.on_world_state(observations_, bus_.now(), is_whole);
  // Agents need the latest positions of uncontrolled robots immediately.
  if (was_uncontrolled || coordinator_.has_uncontrolled_robots()) publish_state();
}

void CoordinatorNode::on_attestation(const msg::AbsenceAttestation& message) {
  const RobotId robot = message.robot();
  if (!coordinator_.is_active()) return;
  const auto heard = heard_at_.find(robot);
  if (heard != heard_at_.end() && bus_.now() - heard->second < kSilence) {
    events_.report(LogLevel::kWarning, robot,
                   "robot {} reports that it is on the floor: its attested absence is ignored", robot);
    drops_.count(DropReason::kRefusedAttestation, robot);
  } else if (coordinator_.on_attestation(robot)) {
    events_.report(LogLevel::kWarning, robot,
                   "an operator attests that robot {} is absent; valid in epoch {}", robot,
                   coordinator_.epoch());
    publish_state();
  } else {
    events_.report(LogLevel::kWarning, robot, "robot {} is not missing: its attested absence is ignored",
                   robot);
    drops_.count(DropReason::kRefusedAttestation);
  }
}

void CoordinatorNode::handle(const OrderPage& page) {
  if (coordinator_.ledger().has_robot(page.process)) failover_.reception().on_agent(page.process, bus_.now());
  order_service_.on_page(page);
}

void CoordinatorNode::handle(const OrderReport& report) {
  if (coordinator_.ledger().has_robot(report.robot)) failover_.reception().on_agent(report.robot, bus_.now());
  order_service_.on_report(report);
}

void CoordinatorNode::handle(const Proposal& proposal) {
  if (coordinator_.ledger().has_robot(proposal.robot))
    failover_.reception().on_agent(proposal.robot, bus_.now());
  observe_epoch(proposal.robot, proposal.epoch, EpochHolder::kAgent);
  if (const auto verdict = coordinator_.on_proposal(proposal)) answer(*verdict);
}

void CoordinatorNode::observe_epoch(RobotId robot, Epoch epoch, EpochHolder holder) {
  if (!coordinator_.ledger().has_robot(robot)) return;
  failover_.on_obeyed_epoch(epoch, coordinator_.is_granting(), bus_.now(), robot, holder);
  apply_epoch();
}

void CoordinatorNode::answer(const Verdict& verdict) {
  msg::Verdict message = encode(verdict);
  publish(self_, verdict_writers_.at(verdict.robot), message, bus_.now());
}

void CoordinatorNode::apply_epoch() {
  if (failover_.epoch() == coordinator_.epoch()) return;
  coordinator_.begin_epoch(failover_.epoch());
  order_service_.begin_epoch();
  event_logger_.reset();
  report_role();
  publish_state();
  // While this coordinator was a standby, it did not announce the orders that it received.
  if (coordinator_.is_active()) order_service_.announce_all();
}

void CoordinatorNode::update_failover() {
  bus_.at(bus_.now() + Failover::kUpdatePeriod, [this] { update_failover(); });
  if (bus_.now() < updated_at_) forget_times();
  updated_at_ = bus_.now();
  failover_.update(bus_.now(), coordinator_.is_granting());
  apply_epoch();
}

void CoordinatorNode::forget_times() {
  heard_at_.clear();
  order_service_.forget_times();
  coordinator_.forget_times();
}

void CoordinatorNode::publish_state() {
  auto state = coordinator_.state();
  state.coordinator(self_.number);
  state.remembers_orders(order_service_.orders().is_complete());
  encode(failover_.cause(), state);
  publish(self_, state_writer_, state, bus_.now());
  event_logger_.update(state, coordinator_.ledger().conflicts(), bus_.now());
}

void CoordinatorNode::publish_state_periodically() {
  bus_.at(bus_.now() + Failover::kHeartbeatPeriod, [this] { publish_state_periodically(); });
  order_service_.update();
  if (coordinator_.is_active() || standby_periods_++ % kStandbyAnnouncePeriod == 0) publish_state();
}

void CoordinatorNode::publish_ledger() {
  bus_.at(bus_.now() + cycle_, [this] { publish_ledger(); });
  if (!coordinator_.is_granting()) return;
  for (msg::LedgerPage& page : ledger_pages(coordinator_.ledger(), coordinator_.epoch()))
    publish(self_, ledger_writer_, page, bus_.now());
}

}  // namespace sidestep
