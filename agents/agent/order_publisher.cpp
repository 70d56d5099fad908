// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/order_publisher.hpp"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "common/messaging/order_codec.hpp"
#include "common/messaging/topics.hpp"

namespace sidestep {
namespace {

constexpr Duration kStatusPeriod{1'000'000'000};
// Announced orders are repeated to the coordinator immediately, but at most at this interval.
constexpr Duration kConfirmationPeriod{100'000'000};

}  // namespace

OrderPublisher::OrderPublisher(Bus& bus, RobotId robot)
    : bus_(bus),
      robot_(robot),
      order_writer_(bus.advertise(topics::kAgentOrders)),
      status_writer_(bus.advertise(topics::kOrderStatus)) {}

// A time in the future was recorded before this process's clock was set back.
bool OrderPublisher::has_elapsed(Duration period, Time since) const {
  return std::chrono::abs(bus_.now() - since) >= period;
}

void OrderPublisher::on_page(const OrderPage& page, Agent& agent) {
  if (const auto missing = agent.take_missing_orders(); !missing.empty()) publish(missing, agent);
  if (page.count == 0) {
    for (const RememberedOrder& order : page.orders) announced_.merge(order);
    confirm_orders(agent);
  }
  const auto holds = [&](const RememberedOrder& order) {
    const bool concerns = order.order.robot == robot_ || order.order.robot == kAllRobots;
    return concerns && order.order.kind == msg::OrderKind::ORDER_HOLD;
  };
  // The coordinator confirms a hold only after an agent has reported that it remembers the hold.
  if (page.count == 0 && std::ranges::any_of(page.orders, holds)) published_at_ = {};
  publish_status(agent);
}

void OrderPublisher::publish(std::span<const RememberedOrder> orders, const Agent& agent) {
  for (msg::OrderMemory& page : encode(orders, agent.assignment().is_known(), true)) {
    page.process(robot_);
    page.header().sender(robot_);
    page.header().incarnation(agent.incarnation());
    order_writer_.publish(page, bus_.now());
  }
}

void OrderPublisher::confirm_orders(const Agent& agent) {
  if (announced_.empty() || !has_elapsed(kConfirmationPeriod, confirmed_at_)) return;
  confirmed_at_ = bus_.now();
  publish(announced_.all(), agent);
  announced_ = {};
}

void OrderPublisher::publish_status(const Agent& agent) {
  if (agent.is_superseded()) return;
  OrderReport report = agent.order_report();
  const auto news = [](const OrderReport& r) {
    const auto reason = r.blockage ? r.blockage->reason : msg::BlockReason::BLOCK_NONE;
    return std::tuple(r.client, r.number, r.progress.state, r.progress.goal_index, r.is_held, reason);
  };
  if (news(report) == news(report_) && !has_elapsed(kStatusPeriod, published_at_)) return;
  published_at_ = bus_.now();
  report_ = report;
  report.remaining_s = agent.remaining_s();
  msg::OrderStatus status = encode(report);
  status.header().sender(robot_);
  status.header().incarnation(agent.incarnation());
  status_writer_.publish(status, bus_.now());
}

}  // namespace sidestep
