// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_keeper.hpp"

#include <algorithm>
#include <utility>

namespace sidestep {

OrderKeeper::OrderKeeper(const FloorSpec& floor, std::uint32_t coordinator_id)
    : field_(floor.field), radius_m_(floor.radius_m), id_(coordinator_id) {
  for (const RobotSpec& robot : floor.robots) has_goals_[robot.id] = !robot.goals.empty();
}

bool OrderKeeper::merge(const RememberedOrder& order) {
  const bool is_stored = book_.merge(order) == OrderBook::Outcome::kStored;
  if (is_stored) changes_.push_back(order);
  return is_stored;
}

bool OrderKeeper::merge_of_other(const RememberedOrder& order) {
  if (!is_known(order.order.robot) || book_.knows(order.order)) return merge_progress(order);
  const bool is_hold = order.order.kind == msg::OrderKind::ORDER_HOLD;
  const bool is_zone = order.order.kind == msg::OrderKind::ORDER_ZONE;
  const bool is_full = (is_hold && book_.hold_count() >= kMaxMergedHolds) ||
                       (is_zone && book_.zone_count() >= kMaxMergedZones);
  if (!is_full) return merge(order);
  return !book_.is_held(kAllRobots) && hold_all(order.order.number);
}

bool OrderKeeper::merge_progress(const RememberedOrder& order) {
  return is_known(order.order.robot) && merge(order);
}

bool OrderKeeper::hold_all(OrderNumber at_least) {
  const OrderNumber number = std::max(at_least, book_.newest_number() + 1);
  return merge({{msg::OrderKind::ORDER_HOLD, kAllRobots, id_, number}});
}

msg::OrderResult OrderKeeper::on_order(const Order& order) {
  if (!is_known(order.robot)) return msg::OrderResult::RESULT_UNKNOWN_ROBOT;
  const auto is_on_field = [&](const Goal& goal) { return field_.contains(goal.position_m, radius_m_); };
  if (!std::ranges::all_of(order.goals, is_on_field)) return msg::OrderResult::RESULT_OUTSIDE_FIELD;
  switch (book_.admit(order)) {
    case OrderBook::Outcome::kStored:
      changes_.push_back({order});
      [[fallthrough]];
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
  for (const RememberedOrder& order : page.orders) is_new |= merge_of_other(order);
  if (page.count == 0 || is_complete_) return is_new;
  // The pages of a process arrive in order, but this process may have missed the first pages.
  std::uint32_t& next = next_page_[page.process];
  next = page.is_complete && (page.index == 0 || page.index == next) ? page.index + 1 : 0;
  if (next == page.count) complete();
  return is_new || is_complete_;
}

void OrderKeeper::on_registration(bool agent_knows_orders) {
  if (agent_knows_orders) complete();
}

void OrderKeeper::complete() {
  is_complete_ = true;
  next_page_.clear();
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
  // The time is in the future if this process's clock was set back.
  if (!waiting_since_ || now < *waiting_since_) waiting_since_ = now;
  if (!has_history) {
    // Without history, no order can have been carried out.
    for (const auto& [robot, has_goals] : has_goals_) {
      if (has_goals) merge({{msg::OrderKind::ORDER_GO, robot, static_cast<ClientId>(Sender::kScenario), 1}});
    }
  } else if (now - *waiting_since_ < kMaxWait) {
    return false;
  } else {
    hold_all(static_cast<OrderNumber>(to_ns(now)));
  }
  complete();
  return true;
}

std::vector<RememberedOrder> OrderKeeper::take_changes() { return std::exchange(changes_, {}); }

}  // namespace sidestep
