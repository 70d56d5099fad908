// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/assignment.hpp"

#include <algorithm>
#include <array>

namespace sidestep {
namespace {

constexpr std::array kFromHighestRank{Rank::kOperator, Rank::kReferee, Rank::kClient, Rank::kScenario};

// With more, what has changed since the whole memory is forgotten.
constexpr std::size_t kMaxPages = 256;

bool is_zone(const Order& order) {
  return order.kind == msg::OrderKind::ORDER_ZONE || order.kind == msg::OrderKind::ORDER_REMOVE_ZONE;
}

bool is_to_do(const RememberedOrder* order) {
  return order && order->order.kind == msg::OrderKind::ORDER_GO && !order->progress.is_finished();
}

}  // namespace

void Assignment::on_page(std::shared_ptr<const OrderPage> page) {
  if (!is_coordinator(page->process)) return;
  bool concerns_robot = false, concerns_zones = false;
  for (const RememberedOrder& order : page->orders) {
    if (!concerns(order)) continue;
    const bool is_new = book_.merge(order) == OrderBook::Outcome::kStored;
    concerns_robot = true;
    concerns_zones |= is_new && is_zone(order.order);
  }
  if (concerns_zones) {
    zones_ = book_.zones();
    ++zone_revision_;
  }
  if (page->count > 0)
    add(std::move(page));
  else if (memory_.size() < kMaxPages)
    memory_.push_back(std::move(page));
  if (!concerns_robot) return;
  is_held_ = book_.is_held(robot_);
  choose();
}

void Assignment::add(std::shared_ptr<const OrderPage> page) {
  Round& round = rounds_[page->process];
  if (page->index == 0) round = {};
  if (page->index != round.pages.size()) return;
  for (const RememberedOrder& order : page->orders) {
    if (concerns(order)) round.book.merge(order);
  }
  const bool is_last = page->index + 1 == page->count;
  const bool is_complete = page->is_complete;
  round.pages.push_back(std::move(page));
  if (!is_last) return;
  missing_ = book_.missing_in(round.book);
  if (is_complete) {
    is_known_ = true;
    memory_ = std::move(round.pages);
  }
  round = {};
}

std::vector<RememberedOrder> Assignment::all() const {
  OrderBook whole;
  for (const auto& page : memory_) {
    for (const RememberedOrder& order : page->orders) whole.merge(order);
  }
  for (const RememberedOrder& order : book_.all()) whole.merge(order);
  return whole.all();
}

OrderReport Assignment::report() const {
  OrderReport report{robot_, client_, number_, progress_};
  report.is_held = is_held_;
  return report;
}

OtherAssignment Assignment::other(RobotId robot) const {
  OrderBook book;
  for (const auto& page : memory_) {
    for (const RememberedOrder& order : page->orders) {
      if (order.order.robot == robot || order.order.robot == kAllRobots) book.merge(order);
    }
  }
  OtherAssignment other;
  other.is_held = book.is_held(robot);
  for (const Rank rank : kFromHighestRank) {
    const RememberedOrder* order = book.drive_order(robot, rank);
    if (!is_to_do(order)) continue;
    other.has_to_go = true;
    other.number = order->order.number;
    const std::vector<Goal>& goals = order->order.goals;
    if (order->progress.goal_index < goals.size())
      other.goal_m = goals[order->progress.goal_index].position_m;
    break;
  }
  return other;
}

void Assignment::choose() {
  for (const Rank rank : kFromHighestRank) {
    const RememberedOrder* order = book_.drive_order(robot_, rank);
    if (!is_to_do(order)) continue;
    if (order->order.number != number_ || order->order.client != client_) take(*order);
    return;
  }
  if (stands()) return;
  // An earlier agent of this robot has finished an order, and the robot is to stay there.
  for (const Rank rank : kFromHighestRank) {
    const RememberedOrder* order = book_.drive_order(robot_, rank);
    if (order && order->progress.state == msg::OrderState::ORDER_ARRIVED) return take(*order);
  }
  if (number_ != 0) drop();
}

void Assignment::take(const RememberedOrder& order) {
  goals_ = order.order.goals.empty() ? scenario_goals_ : order.order.goals;
  client_ = order.order.client;
  number_ = order.order.number;
  progress_ = order.progress;
  ++revision_;
  if (goals_.empty()) return;
  progress_.goal_index = std::min(progress_.goal_index, goals_.size() - 1);
  if (!progress_.is_finished()) progress_.state = msg::OrderState::ORDER_DRIVING;
  book_.report(robot_, client_, number_, progress_);
}

void Assignment::drop() {
  goals_.clear();
  client_ = 0;
  number_ = 0;
  progress_ = {};
  ++revision_;
}

bool Assignment::stands() const {
  const RememberedOrder* order = book_.drive_order(robot_, rank_of(client_));
  return number_ != 0 && order && order->order.client == client_ && order->order.number == number_ &&
         order->order.kind == msg::OrderKind::ORDER_GO;
}

void Assignment::on_arrival() {
  if (progress_.is_finished()) return;
  if (progress_.goal_index + 1 < goals_.size()) {
    ++progress_.goal_index;
    ++revision_;
  } else {
    progress_.state = msg::OrderState::ORDER_ARRIVED;
  }
  book_.report(robot_, client_, number_, progress_);
}

}  // namespace sidestep
