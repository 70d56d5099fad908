// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_keeper.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

OrderKeeper::OrderKeeper(const Scenario& scenario, std::uint32_t coordinator_id)
    : field_(scenario.field), radius_m_(scenario.radius_m), id_(coordinator_id) {
  for (const RobotSpec& robot : scenario.robots) has_goals_[robot.id] = !robot.goals.empty();
}

OrderBook::Outcome OrderKeeper::merge(const RememberedOrder& order) {
  const OrderBook::Outcome outcome = book_.merge(order);
  if (outcome == OrderBook::Outcome::kStored) changes_.push_back(order);
  return outcome;
}

msg::OrderResult OrderKeeper::on_order(const Order& order) {
  if (!is_known(order.robot)) return msg::OrderResult::RESULT_UNKNOWN_ROBOT;
  const auto is_on_field = [&](const Goal& goal) { return field_.contains(goal.position_m, radius_m_); };
  if (!std::ranges::all_of(order.goals, is_on_field)) return msg::OrderResult::RESULT_OUTSIDE_FIELD;
  switch (merge({order})) {
    case OrderBook::Outcome::kStored:
    case OrderBook::Outcome::kKnown:
      return msg::OrderResult::RESULT_REMEMBERED;
    case OrderBook::Outcome::kReplaced:
      return msg::OrderResult::RESULT_REPLACED;
    case OrderBook::Outcome::kFull:
      break;
  }
  return msg::OrderResult::RESULT_TOO_MANY;
}

bool OrderKeeper::on_page(const OrderPage& page) {
  bool is_new = false;
  for (const RememberedOrder& order : page.orders) {
    if (is_known(order.order.robot)) is_new |= merge(order) == OrderBook::Outcome::kStored;
  }
  if (page.count == 0) return is_new;
  // The pages of a process arrive in order, but the first ones may have been sent before this process heard
  // it.
  std::uint32_t& next = next_page_[page.process];
  next = page.is_complete && (page.index == 0 || page.index == next) ? page.index + 1 : 0;
  const bool completes = !is_complete_ && next == page.count;
  is_complete_ |= completes;
  return is_new || completes;
}

bool OrderKeeper::on_report(const OrderReport& report) {
  return book_.report(report.robot, report.client, report.number, report.progress);
}

bool OrderKeeper::update(bool is_granting, bool has_history, Time now) {
  if (is_complete_) return false;
  if (!is_granting) {
    waiting_since_.reset();
    return false;
  }
  if (!waiting_since_) waiting_since_ = now;
  if (!has_history) {
    // No order can have been carried out.
    for (const auto& [robot, has_goals] : has_goals_) {
      if (has_goals) merge({{msg::OrderKind::ORDER_GO, robot, static_cast<ClientId>(Sender::kScenario), 1}});
    }
  } else if (now - *waiting_since_ < kMaxWait) {
    return false;
  } else {
    const auto number = std::max(static_cast<OrderNumber>(to_ns(now)), book_.newest_number() + 1);
    merge({{msg::OrderKind::ORDER_HOLD, kAllRobots, id_, number}});
  }
  return is_complete_ = true;
}

std::vector<RememberedOrder> OrderKeeper::take_changes() { return std::exchange(changes_, {}); }

}  // namespace sidestep
