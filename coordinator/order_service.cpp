// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_service.hpp"

#include <algorithm>

#include "common/messaging/order_codec.hpp"
#include "coordinator/publish.hpp"

namespace sidestep {
namespace {

constexpr Duration kPeriod{1'000'000'000};
// Minimum interval between announcements to new agents.
constexpr Duration kMinPeriod{50'000'000};
// Interval of announcements while agents have yet to register; see announce_to_registering_agents().
constexpr Duration kRegisteringPeriod{200'000'000};

}  // namespace

OrderService::OrderService(Bus& bus, const FloorSpec& floor, const CoordinatorIdentity& self,
                           Coordinator& coordinator, const EventReporter& events,
                           std::function<void()> changed)
    : bus_(bus),
      self_(self),
      coordinator_(coordinator),
      events_(events),
      changed_(std::move(changed)),
      orders_(floor, process_of(self.number)),
      answer_writer_(bus.advertise(topics::kOrderAnswer)),
      memory_writer_(bus.advertise(topics::kOrderMemory)) {
  apply_holds();
}

void OrderService::on_order(const msg::Order& message) {
  const auto order = decode(message, bus_.now());
  const auto result = order ? orders_.on_order(*order) : msg::OrderResult::RESULT_MALFORMED;
  if (!order)
    drops_.count(DropReason::kMalformedOrder);
  else if (result != msg::OrderResult::RESULT_REMEMBERED)
    drops_.count(DropReason::kRefusedOrder);
  const bool is_announced = apply();
  if (!coordinator_.is_active()) return;
  // An order that changes nothing is not remembered, for example a resume while no robot is held.
  const bool is_to_remember = result == msg::OrderResult::RESULT_REMEMBERED && orders_.book().stands(*order);
  if (!is_to_remember) return answer(message.header().sender(), message.terms().order_number(), result);
  confirmations_.add(*order);
  if (!is_announced) to_announce_again_.merge(*orders_.book().occupant_of(*order));
}

void OrderService::on_page(const OrderPage& page) {
  if (page.process == process_of(self_.number)) return;
  // Only agents of robots on the roster confirm orders, because a later coordinator need not hear other
  // agents.
  if (coordinator_.ledger().has_robot(page.process) || is_coordinator(page.process))
    confirmations_.on_page(page);
  confirm();
  const bool was_complete = orders_.is_complete();
  if (orders_.on_page(page)) {
    has_learned_ = true;
    apply();
    announce_to_registering_agents();
  }
  if (orders_.is_complete() == was_complete) return;
  apply_holds();
  changed_();
}

void OrderService::on_report(const OrderReport& report) {
  (void)orders_.on_report(report);
  if (coordinator_.ledger().has_robot(report.robot)) confirmations_.on_report(report);
}

void OrderService::on_obeyed(RobotId robot) {
  if (!confirmations_.is_waiting()) return;
  confirmations_.on_obeyed(robot);
  confirm();
}

void OrderService::on_registered(const Registration& registration) {
  has_history_ |= registration.has_moved;
  const bool was_complete = orders_.is_complete();
  orders_.on_registration(registration.knows_orders);
  if (orders_.is_complete() != was_complete) {
    apply_holds();
    announce_all();  // agents that know nothing wait for a complete memory
    changed_();
  }
  if (!registration.knows_orders) repeat();
}

void OrderService::repeat() {
  const bool is_due = !announced_at_ || bus_.now() - *announced_at_ > kMinPeriod;
  if (orders_.is_complete() && is_due) announce_all();
}

void OrderService::update_memory() {
  if (!orders_.update(coordinator_.is_granting(), has_history_, bus_.now())) return;
  if (has_history_)
    events_.report(LogLevel::kWarning, {},
                   "no process remembers the orders: holding all robots until an operator resumes them");
  apply();
  apply_holds();
  announce_all();
  changed_();
}

void OrderService::update() {
  update_memory();
  confirm();
  announce_again();
  announce_to_registering_agents();
}

void OrderService::begin_epoch() {
  has_history_ = false;
  confirmations_.clear();
  to_announce_again_ = {};
}

void OrderService::announce_all() { announce(orders_.book().all(), false); }

void OrderService::announce_periodically() {
  bus_.at(bus_.now() + kPeriod, [this] { announce_periodically(); });
  announce_all();
}

void OrderService::answer(ClientId client, OrderNumber number, msg::OrderResult result) {
  msg::OrderAnswer answer;
  answer.client(client);
  answer.order_number(number);
  answer.result(result);
  answer.newest_number(orders_.book().newest_number());
  publish(self_, answer_writer_, answer, bus_.now());
}

void OrderService::confirm() {
  for (const Order& order : confirmations_.take_confirmed(orders_.book())) {
    // The effect of a resume remains, even if another resume makes it redundant.
    const bool is_remembered = orders_.book().stands(order) || order.kind == msg::OrderKind::ORDER_RESUME;
    answer(order.client, order.number,
           is_remembered ? msg::OrderResult::RESULT_REMEMBERED : msg::OrderResult::RESULT_REPLACED);
  }
}

void OrderService::apply_holds() {
  for (const RobotId robot : coordinator_.ledger().roster())
    coordinator_.set_held(robot, orders_.is_held(robot));
}

bool OrderService::apply() {
  const auto changes = orders_.take_changes();
  if (changes.empty()) return false;
  const auto is_hold = [](const RememberedOrder& order) {
    return order.order.kind == msg::OrderKind::ORDER_HOLD || order.order.kind == msg::OrderKind::ORDER_RESUME;
  };
  if (std::ranges::any_of(changes, is_hold)) apply_holds();
  if (coordinator_.is_active()) announce(changes, true);
  return coordinator_.is_active();
}

void OrderService::announce(std::span<const RememberedOrder> orders, bool have_changed) {
  if (!have_changed) {
    announced_at_ = bus_.now();
    has_learned_ = false;
  }
  for (msg::OrderMemory& page : encode(orders, orders_.is_complete(), have_changed)) {
    page.process(process_of(self_.number));
    publish(self_, memory_writer_, page, bus_.now());
  }
}

void OrderService::announce_again() {
  if (to_announce_again_.empty()) return;
  announce(to_announce_again_.all(), true);
  to_announce_again_ = {};
}

void OrderService::announce_to_registering_agents() {
  if (!coordinator_.is_active() || coordinator_.is_granting()) return;
  const bool is_due =
      !announced_at_ || bus_.now() - *announced_at_ > (has_learned_ ? kMinPeriod : kRegisteringPeriod);
  if (is_due) announce_all();
}

}  // namespace sidestep
