// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator_node.hpp"

#include <algorithm>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/observation_codec.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/senders.hpp"
#include "common/protocol/reason_text.hpp"
#include "coordinator/ledger_pages.hpp"

namespace sidestep {
namespace {

// A standby announces itself every kStandbyAnnouncePeriod heartbeat periods.
constexpr int kStandbyAnnouncePeriod = 10;
// A robot that has been heard of within this time is not absent.
constexpr Duration kSilence{1'000'000'000};
constexpr Duration kOrderPeriod{1'000'000'000};
// A new agent is told the orders at once, but not more often than this.
constexpr Duration kMinOrderPeriod{50'000'000};
// While agents wait to be told what they remember, before they register.
constexpr Duration kRegisteringOrderPeriod{200'000'000};

}  // namespace

CoordinatorNode::CoordinatorNode(Bus& bus, const Scenario& scenario, const CoordinatorIdentity& self,
                                 bool is_standby)
    : bus_(bus),
      self_(self),
      cycle_(scenario.cycle),
      max_clock_difference_(max_clock_difference(scenario.clock_bound_s)),
      failover_(self, is_standby, bus.now(), {roster_of(scenario), scenario.cycle}),
      coordinator_(floor_rules(scenario), roster_of(scenario), failover_.epoch(), max_clock_difference_,
                   scenario.cycle),
      orders_(scenario, static_cast<std::uint32_t>(Sender::kCoordinator) + self.number),
      counters_(bus, static_cast<std::uint32_t>(Sender::kCoordinator) + self.number, self.incarnation,
                [this](DropCounters& drops) { count_drops(drops); }) {
  state_writer_ = bus_.advertise(topics::kCoordinator);
  ledger_writer_ = bus_.advertise(topics::kLedger);
  answer_writer_ = bus_.advertise(topics::kOrderAnswer);
  memory_writer_ = bus_.advertise(topics::kOrderMemory);
  for (const RobotSpec& robot : scenario.robots) {
    verdict_writers_.emplace(robot.id, bus_.advertise(topics::kVerdict, robot.id));
    bus_.subscribe(topics::kFeedback, robot.id, [this, id = robot.id](const msg::Feedback& message) {
      take(decode(message, id, bus_.now()), DropReason::kMalformedFeedback, id);
    });
  }
  bus_.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState& message) {
    take(decode(message, bus_.now()), DropReason::kMalformedCoordinatorState);
  });
  bus_.subscribe(topics::kRegistration, [this](const msg::Registration& message) {
    take(decode(message, bus_.now()), DropReason::kMalformedRegistration);
  });
  bus_.subscribe(topics::kProposal, [this](const msg::Proposal& message) {
    take(decode(message, bus_.now()), DropReason::kMalformedProposal);
  });
  bus_.subscribe(topics::kWorld, [this](const msg::WorldState& message) { on_world(message); });
  bus_.subscribe(topics::kAttestation,
                 [this](const msg::AbsenceAttestation& message) { on_attestation(message); });
  bus_.subscribe(topics::kOrder, [this](const msg::Order& message) { on_order(message); });
  for (const auto& memory : {topics::kOrderMemory, topics::kAgentOrders}) {
    bus_.subscribe(memory, [this](const msg::OrderMemory& message) {
      take(decode(message, bus_.now()), DropReason::kMalformedOrder);
    });
  }
  bus_.subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& message) {
    take(decode(message), DropReason::kMalformedOrder);
  });
  apply_holds();
  update_failover();
  publish_state_periodically();
  publish_ledger();
  publish_orders_periodically();
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

template <typename Message>
void CoordinatorNode::publish(Writer<Message>& writer, Message& message) {
  message.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number);
  message.header().incarnation(self_.incarnation);
  writer.publish(message, bus_.now());
}

template <typename Decoded>
void CoordinatorNode::take(const std::optional<Decoded>& decoded, DropReason reason,
                           std::optional<RobotId> robot) {
  if (decoded)
    handle(*decoded);
  else
    drops_.count(reason, robot);
}

void CoordinatorNode::count_drops(DropCounters& drops) const {
  drops.add(drops_);
  drops.add(coordinator_.drops());
  drops.count(DropReason::kImplausibleEpoch, std::nullopt, failover_.invalid());
  drops.count(DropReason::kFrequentEpoch, std::nullopt, failover_.too_frequent());
}

void CoordinatorNode::handle(const CoordinatorHeartbeat& heartbeat) {
  failover_.on_heartbeat(heartbeat, bus_.now());
  apply_epoch();
  if (!heartbeat.remembers_orders) repeat_orders();
}

void CoordinatorNode::handle(const Registration& registration) {
  if (coordinator_.ledger().has_robot(registration.robot))
    failover_.reception().on_registration(registration.robot, bus_.now());
  if (registration.epoch == 0) return;  // the agent knows no coordinator
  observe_epoch(registration.robot, registration.epoch, EpochHolder::kAgent);
  if (registration.asks_for_orders) return repeat_orders();
  const bool was_granting = coordinator_.is_granting();
  if (const auto verdict = coordinator_.on_registration(registration)) {
    answer(*verdict);
    report_registration(registration, *verdict);
    if (verdict->reasons.front() == msg::Reason::REASON_GRANTED) learn_of_orders(registration);
  }
  if (coordinator_.is_granting() != was_granting) {
    update_orders();
    publish_state();
  }
}

void CoordinatorNode::learn_of_orders(const Registration& registration) {
  has_history_ |= registration.has_moved;
  const bool was_complete = orders_.is_complete();
  orders_.on_registration(registration.knows_orders);
  if (orders_.is_complete() != was_complete) {
    apply_holds();
    publish_orders(orders_.book().all(), false);  // agents that know nothing wait for a complete memory
    publish_state();
  }
  if (!registration.knows_orders) repeat_orders();
}

void CoordinatorNode::repeat_orders() {
  const bool is_due = !orders_published_at_ || bus_.now() - *orders_published_at_ > kMinOrderPeriod;
  if (orders_.is_complete() && is_due) publish_orders(orders_.book().all(), false);
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

void CoordinatorNode::handle(const Feedback& feedback) {
  observe_epoch(feedback.robot, feedback.obeyed_epoch, EpochHolder::kRobot);
  if (!feedback.is_absent()) heard_at_[feedback.robot] = bus_.now();
  const bool is_granted = !feedback.is_off_reference && !feedback.is_absent();
  if (coordinator_.ledger().has_robot(feedback.robot))
    failover_.reception().on_fact(feedback.robot, feedback.executing.number, is_granted, bus_.now());
  if (feedback.obeyed_epoch == coordinator_.epoch() && confirmations_.is_waiting()) {
    confirmations_.on_obeyed(feedback.robot);
    confirm_orders();
  }
  const bool was_quarantined = coordinator_.ledger().is_quarantined(feedback.robot);
  if (coordinator_.on_feedback(feedback, bus_.now()) || was_quarantined) return;
  events_.report(LogLevel::kWarning, feedback.robot,
                 "robot {} executes version {}, which it was never granted", feedback.robot,
                 feedback.executing.number);
  publish_state();
}

void CoordinatorNode::on_world(const msg::WorldState& message) {
  const Time valid_at = time_from_ns(message.valid_at_ns());
  const bool is_from_vision = message.header().sender() == static_cast<std::uint32_t>(Sender::kVision);
  // The farther ahead it is, the less certain are the places in it.
  if (!is_from_vision || valid_at > bus_.now() + max_vision_lead(max_clock_difference_)) {
    drops_.count(is_from_vision ? DropReason::kFutureWorld : DropReason::kMalformedWorld);
    return;
  }
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
  coordinator_.on_world(observations_, bus_.now(), is_whole);
  // Agents need the latest places at once.
  if (was_uncontrolled || coordinator_.has_uncontrolled_robots()) publish_state();
}

void CoordinatorNode::on_attestation(const msg::AbsenceAttestation& message) {
  const RobotId robot = message.robot();
  if (message.header().sender() != static_cast<std::uint32_t>(Sender::kOperator)) {
    drops_.count(DropReason::kMalformedAttestation);
    return;
  }
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

void CoordinatorNode::handle(const OrderReport& report) {
  (void)orders_.on_report(report);
  if (!coordinator_.ledger().has_robot(report.robot)) return;
  failover_.reception().on_agent(report.robot, bus_.now());
  confirmations_.on_report(report);
}

void CoordinatorNode::confirm_orders() {
  for (const Order& order : confirmations_.take_confirmed(orders_.book())) {
    // What a resume lifts is lifted, also if another one makes it meaningless.
    const bool is_remembered = orders_.book().stands(order) || order.kind == msg::OrderKind::ORDER_RESUME;
    answer(order.client, order.number,
           is_remembered ? msg::OrderResult::RESULT_REMEMBERED : msg::OrderResult::RESULT_REPLACED);
  }
}

void CoordinatorNode::on_order(const msg::Order& message) {
  const auto order = decode(message, bus_.now());
  const auto result = order ? orders_.on_order(*order) : msg::OrderResult::RESULT_MALFORMED;
  if (!order)
    drops_.count(DropReason::kMalformedOrder);
  else if (result != msg::OrderResult::RESULT_REMEMBERED)
    drops_.count(DropReason::kRefusedOrder);
  const bool is_announced = apply_orders();
  if (!coordinator_.is_active()) return;
  // Nobody needs to remember an order that changes nothing, such as a resume while nobody is held.
  const bool is_to_remember = result == msg::OrderResult::RESULT_REMEMBERED && orders_.book().stands(*order);
  if (!is_to_remember) return answer(message.header().sender(), message.terms().order_number(), result);
  confirmations_.add(*order);
  if (!is_announced) unheard_.merge(*orders_.book().in_place_of(*order));
}

void CoordinatorNode::announce_again() {
  if (unheard_.empty()) return;
  publish_orders(unheard_.all(), true);
  unheard_ = {};
}

void CoordinatorNode::answer(ClientId client, OrderNumber number, msg::OrderResult result) {
  msg::OrderAnswer answer;
  answer.client(client);
  answer.order_number(number);
  answer.result(result);
  answer.newest_number(orders_.book().newest_number());
  publish(answer_writer_, answer);
}

void CoordinatorNode::handle(const OrderPage& page) {
  if (page.process == static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number) return;
  const bool is_of_roster = coordinator_.ledger().has_robot(page.process);
  if (is_of_roster) failover_.reception().on_agent(page.process, bus_.now());
  // Later coordinators need not hear other robots' agents.
  if (is_of_roster || is_coordinator(page.process)) confirmations_.on_page(page);
  confirm_orders();
  const bool was_complete = orders_.is_complete();
  if (orders_.on_page(page)) {
    has_learned_orders_ = true;
    apply_orders();
    tell_registering_agents();
  }
  if (orders_.is_complete() == was_complete) return;
  apply_holds();
  publish_state();
}

void CoordinatorNode::update_orders() {
  if (!orders_.update(coordinator_.is_granting(), has_history_, bus_.now())) return;
  if (has_history_)
    events_.report(LogLevel::kWarning, {},
                   "no process remembers what was ordered: holds all robots until an operator resumes");
  apply_orders();
  apply_holds();
  publish_orders(orders_.book().all(), false);
  publish_state();
}

void CoordinatorNode::apply_holds() {
  for (const RobotId robot : coordinator_.ledger().roster())
    coordinator_.set_held(robot, orders_.is_held(robot));
}

bool CoordinatorNode::apply_orders() {
  const auto changes = orders_.take_changes();
  if (changes.empty()) return false;
  const auto is_hold = [](const RememberedOrder& order) {
    return order.order.kind == msg::OrderKind::ORDER_HOLD || order.order.kind == msg::OrderKind::ORDER_RESUME;
  };
  if (std::ranges::any_of(changes, is_hold)) apply_holds();
  if (coordinator_.is_active()) publish_orders(changes, true);
  return coordinator_.is_active();
}

void CoordinatorNode::publish_orders(std::span<const RememberedOrder> orders, bool have_changed) {
  if (!have_changed) {
    orders_published_at_ = bus_.now();
    has_learned_orders_ = false;
  }
  for (msg::OrderMemory& page : encode(orders, orders_.is_complete(), have_changed)) {
    page.process(static_cast<std::uint32_t>(Sender::kCoordinator) + self_.number);
    publish(memory_writer_, page);
  }
}

void CoordinatorNode::tell_registering_agents() {
  if (!coordinator_.is_active() || coordinator_.is_granting()) return;
  const bool is_due =
      !orders_published_at_ ||
      bus_.now() - *orders_published_at_ > (has_learned_orders_ ? kMinOrderPeriod : kRegisteringOrderPeriod);
  if (is_due) publish_orders(orders_.book().all(), false);
}

void CoordinatorNode::publish_orders_periodically() {
  bus_.at(bus_.now() + kOrderPeriod, [this] { publish_orders_periodically(); });
  publish_orders(orders_.book().all(), false);
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
  publish(verdict_writers_.at(verdict.robot), message);
}

void CoordinatorNode::apply_epoch() {
  if (failover_.epoch() == coordinator_.epoch()) return;
  coordinator_.begin_epoch(failover_.epoch());
  has_history_ = false;
  confirmations_.clear();
  unheard_ = {};
  changes_.reset();
  report_role();
  publish_state();
  // Orders that arrived while it stood by were announced by another, if at all.
  if (coordinator_.is_active()) publish_orders(orders_.book().all(), false);
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
  orders_published_at_.reset();
  coordinator_.forget_times();
}

void CoordinatorNode::publish_state() {
  auto state = coordinator_.state();
  state.coordinator(self_.number);
  state.remembers_orders(orders_.is_complete());
  encode(failover_.cause(), state);
  publish(state_writer_, state);
  changes_.update(state, coordinator_.ledger().conflicts(), bus_.now());
}

void CoordinatorNode::publish_state_periodically() {
  bus_.at(bus_.now() + Failover::kHeartbeatPeriod, [this] { publish_state_periodically(); });
  update_orders();
  confirm_orders();
  announce_again();
  tell_registering_agents();
  if (coordinator_.is_active() || standby_periods_++ % kStandbyAnnouncePeriod == 0) publish_state();
}

void CoordinatorNode::publish_ledger() {
  bus_.at(bus_.now() + cycle_, [this] { publish_ledger(); });
  if (!coordinator_.is_granting()) return;
  for (msg::LedgerPage& page : ledger_pages(coordinator_.ledger(), coordinator_.epoch()))
    publish(ledger_writer_, page);
}

}  // namespace sidestep
