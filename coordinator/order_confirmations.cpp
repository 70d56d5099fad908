// SPDX-License-Identifier: Apache-2.0
#include "coordinator/order_confirmations.hpp"

namespace sidestep {
namespace {

bool is_hold(const Order& order) { return order.kind == msg::OrderKind::ORDER_HOLD; }

}  // namespace

void OrderConfirmations::add(const Order& order) {
  waiting_.try_emplace({order.client, order.number}, Waiting{order});
}

void OrderConfirmations::on_page(const OrderPage& page) {
  if (waiting_.empty()) return;
  for (const RememberedOrder& remembered : page.orders) {
    const auto found = waiting_.find({remembered.order.client, remembered.order.number});
    if (found != waiting_.end() && !is_hold(found->second.order)) found->second.is_confirmed = true;
  }
}

void OrderConfirmations::on_report(const OrderReport& report) {
  if (!report.is_held) return;
  for (auto& [key, waiting] : waiting_) {
    const RobotId robot = waiting.order.robot;
    if (is_hold(waiting.order) && (robot == kAllRobots || robot == report.robot))
      waiting.remembered_by.insert(report.robot);
  }
}

void OrderConfirmations::on_obeyed(RobotId robot) {
  for (auto& [key, waiting] : waiting_) waiting.is_confirmed |= waiting.remembered_by.contains(robot);
}

std::vector<Order> OrderConfirmations::take_confirmed(const OrderBook& book) {
  std::vector<Order> confirmed;
  std::erase_if(waiting_, [&](const auto& entry) {
    if (book.stands(entry.second.order) && !entry.second.is_confirmed) return false;
    confirmed.push_back(entry.second.order);
    return true;
  });
  return confirmed;
}

}  // namespace sidestep
