// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/assignment.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace sidestep {
namespace {

constexpr std::array kFromHighestRank{Rank::kOperator, Rank::kReferee, Rank::kClient, Rank::kScenario};

bool is_zone(const Order& order) {
  return order.kind == msg::OrderKind::ORDER_ZONE || order.kind == msg::OrderKind::ORDER_REMOVE_ZONE;
}

bool is_to_do(const RememberedOrder* order) {
  return order && order->order.kind == msg::OrderKind::ORDER_GO && !order->progress.is_finished();
}

}  // namespace

Assignment::Assignment(RobotId robot, std::vector<Goal> scenario_goals, std::vector<RobotId> roster)
    : robot_(robot), scenario_goals_(std::move(scenario_goals)), announced_(std::move(roster)) {}

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
  announced_.on_page(std::move(page), book_);
  if (!concerns_robot) return;
  is_held_ = book_.is_held(robot_);
  choose();
}

OrderReport Assignment::report() const {
  OrderReport report{robot_, client_, number_, progress_};
  report.is_held = is_held_;
  report.client_name = client_name_;
  return report;
}

bool Assignment::yields_to(const PassageContender& other, Time t, Duration period) const {
  return other_passes_first(other, {robot_, number_}, t, period);
}

OtherAssignment Assignment::other(RobotId robot) const {
  const OrderBook book = announced_.of(robot);
  OtherAssignment other;
  other.is_held = book.is_held(robot);
  for (const Rank rank : kFromHighestRank) {
    const RememberedOrder* order = book.drive_order(robot, rank);
    if (!is_to_do(order)) continue;
    other.has_drive_order = true;
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
  // If an earlier agent of this robot has finished an order, the robot must stay at its goal.
  for (const Rank rank : kFromHighestRank) {
    const RememberedOrder* order = book_.drive_order(robot_, rank);
    if (order && order->progress.state == msg::OrderState::ORDER_ARRIVED) return take(*order);
  }
  if (number_ != 0) drop();
}

void Assignment::take(const RememberedOrder& order) {
  goals_ = order.order.goals.empty() ? scenario_goals_ : order.order.goals;
  client_ = order.order.client;
  client_name_ = order.order.client_name;
  number_ = order.order.number;
  progress_ = order.progress;
  ++revision_;
  if (goals_.empty()) return;
  progress_.goal_index = std::min(progress_.goal_index, goals_.size() - 1);
  if (!progress_.is_finished()) progress_.state = msg::OrderState::ORDER_DRIVING;
  report_progress();
}

void Assignment::report_progress() {
  if (book_.report(robot_, client_, number_, progress_)) announced_.on_progress();
}

void Assignment::drop() {
  goals_.clear();
  client_ = 0;
  client_name_ = {};
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
  report_progress();
}

}  // namespace sidestep
