// SPDX-License-Identifier: Apache-2.0
#include "common/client/order_client.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {
namespace {

// A coordinator has forgotten an order if this number of its consecutive complete order memories lack the
// order: a single memory may have been sent before the coordinator received the order.
constexpr int kRoundsUntilForgotten = 3;

bool drives(const Order& order) { return order.kind == msg::OrderKind::ORDER_GO; }

bool stops(const Order& order) { return order.kind == msg::OrderKind::ORDER_HOLD; }

/// Whether an order of this kind stays in force after it was accepted, so that coordinators must not forget
/// it.
bool is_persistent(const Order& order) {
  return drives(order) || stops(order) || order.kind == msg::OrderKind::ORDER_ZONE;
}

/// Whether a later order of the same client completely replaces an earlier one.
bool replaces(const Order& later, const Order& earlier) {
  const auto is_drive = [](const Order& o) { return drives(o) || o.kind == msg::OrderKind::ORDER_CANCEL; };
  const auto is_hold = [](const Order& o) { return stops(o) || o.kind == msg::OrderKind::ORDER_RESUME; };
  const bool covers = later.robot == earlier.robot || later.robot == kAllRobots;
  return covers && ((is_drive(later) && is_drive(earlier)) || (is_hold(later) && is_hold(earlier)));
}

OrderPhase phase_of(const OrderProgress& progress) {
  switch (progress.state) {
    case msg::OrderState::ORDER_ACCEPTED:
      return OrderPhase::kAccepted;
    case msg::OrderState::ORDER_DRIVING:
    case msg::OrderState::ORDER_BLOCKED:
      return OrderPhase::kDriving;
    case msg::OrderState::ORDER_ARRIVED:
    case msg::OrderState::ORDER_LEFT:
      break;
  }
  return OrderPhase::kArrived;
}

bool is_refused(msg::OrderResult result) {
  return result != msg::OrderResult::RESULT_REMEMBERED && result != msg::OrderResult::RESULT_REPLACED;
}

/// Whether the state of an order can no longer change.
bool is_closed(const SentOrder& sent) {
  return is_final(sent.phase) || (!is_persistent(sent.order) && sent.phase == OrderPhase::kAccepted);
}

}  // namespace

OrderClient::OrderClient(Bus& bus, ClientId client, std::string_view name)
    : bus_(bus), client_(client), name_(client_name(name)), writer_(bus.advertise(topics::kOrder)) {
  bus_.subscribe(topics::kOrderAnswer, [this](const msg::OrderAnswer& answer) { on_answer(answer); });
  bus_.subscribe(topics::kOrderStatus, [this](const msg::OrderStatus& status) { on_status(status); });
  bus_.subscribe(topics::kOrderMemory, [this](const msg::OrderMemory& memory) { on_memory(memory); });
  repeat();
}

OrderHandle OrderClient::go(RobotId robot, std::vector<Goal> goals) {
  Order order{msg::OrderKind::ORDER_GO, robot};
  order.goals = std::move(goals);
  return send(std::move(order));
}

OrderHandle OrderClient::zone(std::uint32_t number, Zone zone) {
  Order order{msg::OrderKind::ORDER_ZONE, kAllRobots};
  order.zone_number = number;
  order.zone = std::move(zone);
  return send_zone(std::move(order));
}

OrderHandle OrderClient::remove_zone(std::uint32_t number) {
  Order order{msg::OrderKind::ORDER_REMOVE_ZONE, kAllRobots};
  order.zone_number = number;
  return send_zone(std::move(order));
}

OrderHandle OrderClient::send_zone(Order order) {
  const auto is_same_zone = [&](const auto& entry) {
    const Order& earlier = entry.second.order;
    return (earlier.kind == msg::OrderKind::ORDER_ZONE ||
            earlier.kind == msg::OrderKind::ORDER_REMOVE_ZONE) &&
           earlier.zone_number == order.zone_number;
  };
  // At most one earlier order is stored, because each zone order makes the client forget its predecessor.
  const auto earlier = std::ranges::find_if(sent_, is_same_zone);
  if (earlier != sent_.end()) forget(earlier);
  return send(std::move(order));
}

void OrderClient::replace_earlier(const Order& later) {
  std::vector<OrderHandle> replaced;
  for (const auto& [handle, sent] : sent_) {
    const bool is_open = sent.phase == OrderPhase::kSent || (stops(sent.order) && !is_closed(sent));
    if (is_open && replaces(later, sent.order)) replaced.push_back(handle);
  }
  for (const OrderHandle handle : replaced) {
    const auto sent = sent_.find(handle);
    if (sent != sent_.end()) update(sent->second, OrderPhase::kReplaced, sent->second.goal_index);
  }
}

OrderHandle OrderClient::send(Order order) {
  replace_earlier(order);
  newest_ = std::max(newest_ + 1, static_cast<OrderNumber>(to_ns(bus_.now())));
  order.client = client_;
  order.client_name = name_;
  order.number = newest_;
  publish(order);
  by_number_[newest_] = ++last_handle_;
  sent_.emplace(last_handle_, SentOrder{last_handle_, std::move(order)});
  return last_handle_;
}

SentOrder* OrderClient::find_number(OrderNumber number) {
  const auto handle = by_number_.find(number);
  return handle == by_number_.end() ? nullptr : &sent_.at(handle->second);
}

bool OrderClient::is_followed_by_hold(const SentOrder& resume) const {
  return std::any_of(sent_.upper_bound(resume.handle), sent_.end(),
                     [](const auto& entry) { return stops(entry.second.order); });
}

bool OrderClient::renumber(SentOrder& sent, const msg::OrderAnswer& answer) {
  const bool is_behind = answer.newest_number() > sent.order.number && newest_ >= answer.newest_number();
  const bool is_affected = answer.result() == msg::OrderResult::RESULT_REPLACED ||
                           sent.order.kind == msg::OrderKind::ORDER_HOLD ||
                           sent.order.kind == msg::OrderKind::ORDER_RESUME;
  if (sent.is_number_final || !is_behind || !is_affected || is_refused(answer.result())) return false;
  if (sent.order.kind == msg::OrderKind::ORDER_RESUME) {
    // If this client's clock has already passed the newest number, that number belongs to a later order,
    // perhaps a hold, and this client's clock is not behind.
    const bool is_late = answer.newest_number() <= static_cast<OrderNumber>(to_ns(bus_.now()));
    if (is_late || is_followed_by_hold(sent)) return false;
  }
  sent.is_number_final = true;
  by_number_.erase(sent.order.number);
  sent.order.number = ++newest_;
  by_number_[newest_] = sent.handle;
  publish(sent.order);
  return true;
}

void OrderClient::publish(const Order& order) {
  msg::Order message = encode(order);
  writer_.publish(message, bus_.now());
}

void OrderClient::repeat() {
  bus_.at(bus_.now() + kRepetitionPeriod, [this] { repeat(); });
  for (const auto& [number, sent] : sent_) {
    if (sent.phase == OrderPhase::kSent) publish(sent.order);
  }
}

const SentOrder* OrderClient::find(OrderHandle handle) const {
  const auto found = sent_.find(handle);
  return found == sent_.end() ? nullptr : &found->second;
}

void OrderClient::update(SentOrder& sent, OrderPhase phase, std::size_t goal_index) {
  if (is_closed(sent) || (phase == sent.phase && goal_index == sent.goal_index)) return;
  sent.phase = phase;
  sent.goal_index = goal_index;
  if (is_closed(sent)) {
    missing_.erase(sent.handle);
    ++closed_count_;
  }
  if (on_change_) on_change_(sent);  // the callback may send orders and thereby forget this one
  if (closed_count_ > kMaxFinal)
    forget(std::ranges::find_if(sent_, [](const auto& entry) { return is_closed(entry.second); }));
}

void OrderClient::forget(std::map<OrderHandle, SentOrder>::iterator sent) {
  if (is_closed(sent->second)) --closed_count_;
  by_number_.erase(sent->second.order.number);
  missing_.erase(sent->first);
  sent_.erase(sent);
}

void OrderClient::on_answer(const msg::OrderAnswer& answer) {
  if (answer.client() != client_ || !is_coordinator(answer.header().sender())) return;
  if (is_plausible(answer.newest_number(), bus_.now())) newest_ = std::max(newest_, answer.newest_number());
  SentOrder* const found = find_number(answer.order_number());
  if (!found || found->phase != OrderPhase::kSent || renumber(*found, answer)) return;
  SentOrder& sent = *found;
  sent.refusal = answer.result();
  sent.is_number_final = true;
  switch (answer.result()) {
    case msg::OrderResult::RESULT_REMEMBERED:
      return update(sent, OrderPhase::kAccepted, 0);
    case msg::OrderResult::RESULT_REPLACED:
      return update(sent, OrderPhase::kReplaced, 0);
    default:
      return update(sent, OrderPhase::kRefused, 0);
  }
}

void OrderClient::on_status(const msg::OrderStatus& status) {
  const auto report = decode(status);
  if (!report) return;
  reports_[report->robot] = *report;
  SentOrder* const found = find_number(report->number);
  if (!found || report->client != client_ || found->order.robot != report->robot) return;
  found->blockage = report->blockage;
  const OrderPhase phase = phase_of(report->progress);
  update(*found, report->blockage && !is_final(phase) ? OrderPhase::kBlocked : phase,
         report->progress.goal_index);
}

void OrderClient::on_memory(const msg::OrderMemory& memory) {
  const auto page = decode(memory, bus_.now());
  if (!page || !is_coordinator(page->process)) return;
  const auto memory_known = memories_.find(page->process);
  if (page->count == 0 && memory_known != memories_.end())
    for (const RememberedOrder& order : page->orders) memory_known->second.book.merge(order);
  if (page->count == 0 || !page->is_complete) return;
  Round& round = rounds_[page->process];
  if (page->index == 0) round = {};
  if (page->index != round.next_page) return;
  for (const RememberedOrder& order : page->orders) round.book.merge(order);
  if (++round.next_page != page->count) return;
  memories_[page->process] = {round.book, bus_.now()};
  compare(page->process, round.book);
}

std::optional<OrderBook> OrderClient::remembered_orders() const {
  if (memories_.empty()) return std::nullopt;
  const auto heard_at = [](const auto& entry) { return entry.second.heard_at; };
  const Time newest = std::ranges::max_element(memories_, {}, heard_at)->second.heard_at;
  OrderBook merged;
  for (const auto& [coordinator, memory] : memories_) {
    if (newest - memory.heard_at > kMaxMemoryLag) continue;
    for (const RememberedOrder& order : memory.book.all()) merged.merge(order);
  }
  return merged;
}

bool OrderClient::may_have_zone(std::uint32_t number) const {
  const auto is_this_zone = [&](const Order& order) {
    return order.kind == msg::OrderKind::ORDER_ZONE && order.client == client_ && order.zone_number == number;
  };
  const auto has_set = [&](const auto& entry) {
    return is_this_zone(entry.second.order) && !is_final(entry.second.phase);
  };
  if (std::ranges::any_of(sent_, has_set)) return true;
  const std::optional<OrderBook> remembered = remembered_orders();
  return !remembered || std::ranges::any_of(remembered->zones(), is_this_zone);
}

bool OrderClient::count_lacking_memory(const SentOrder& sent, std::uint32_t coordinator) {
  return ++missing_[sent.handle][coordinator] % kRoundsUntilForgotten == 0;
}

bool OrderClient::is_listed(const SentOrder& sent) const {
  const auto missing = missing_.find(sent.handle);
  return missing != missing_.end() &&
         std::ranges::any_of(missing->second, [](const auto& entry) { return entry.second == 0; });
}

void OrderClient::compare(std::uint32_t coordinator, const OrderBook& remembered) {
  for (const auto& [handle, sent] : sent_) {
    const bool has_ended_others = sent.phase == OrderPhase::kArrived || sent.phase == OrderPhase::kAccepted;
    if (!is_closed(sent) || !has_ended_others) continue;
    if (!remembered.contradicts(sent.order))
      missing_[handle][coordinator] = 0;
    else if (count_lacking_memory(sent, coordinator))
      publish(sent.order);
  }
  std::vector<OrderHandle> open;
  for (const auto& [handle, sent] : sent_) {
    if (is_persistent(sent.order) && !is_closed(sent)) open.push_back(handle);
  }
  for (const OrderHandle handle : open) {
    const auto sent = sent_.find(handle);
    if (sent != sent_.end()) compare(sent->second, coordinator, remembered);
  }
}

void OrderClient::compare(SentOrder& sent, std::uint32_t coordinator, const OrderBook& remembered) {
  const OrderNumber number = sent.order.number;
  const RememberedOrder* const known = remembered.occupant_of(sent.order);
  if (known && known->order.number == number && known->order.client == client_) {
    missing_[sent.handle][coordinator] = 0;
    // Only an answer, or a report from the robot's agent, shows that a second process remembers the order.
    const bool has_started = known->progress.state != msg::OrderState::ORDER_ACCEPTED;
    // The robot's status is usually more recent than the memory, so the memory counts only in these two
    // cases.
    if (known->progress.is_finished() || (sent.phase == OrderPhase::kSent && has_started))
      update(sent, phase_of(known->progress), known->progress.goal_index);
  } else if (known && std::pair(known->order.number, known->order.client) > std::pair(number, client_)) {
    update(sent, OrderPhase::kReplaced, sent.goal_index);
  } else if (stops(sent.order) && remembered.is_lifted(sent.order)) {
    update(sent, OrderPhase::kReplaced, sent.goal_index);
  } else if (sent.phase != OrderPhase::kSent && count_lacking_memory(sent, coordinator)) {
    if (is_listed(sent))
      publish(sent.order);
    else
      update(sent, OrderPhase::kSent, 0);  // the order is then repeated
  }
}

}  // namespace sidestep
