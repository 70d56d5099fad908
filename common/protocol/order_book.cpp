// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/order_book.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace sidestep {
namespace {

/// Whether the first is later. Numbers of different clients may be equal.
bool is_later(const Order& a, const Order& b) {
  return std::pair(a.number, a.client) > std::pair(b.number, b.client);
}

bool is_further(const OrderProgress& a, const OrderProgress& b) {
  return std::tuple(a.is_finished(), a.goal_index, a.state) >
         std::tuple(b.is_finished(), b.goal_index, b.state);
}

constexpr auto kOperator = static_cast<ClientId>(Sender::kOperator);

}  // namespace

OrderBook::Place OrderBook::place_of(const Order& order) {
  switch (order.kind) {
    case msg::OrderKind::ORDER_GO:
    case msg::OrderKind::ORDER_CANCEL:
      return {Kind::kDrive, order.robot, static_cast<std::uint32_t>(rank_of(order.client)), 0};
    case msg::OrderKind::ORDER_HOLD:
      return {Kind::kHold, order.robot, order.client, 0};
    case msg::OrderKind::ORDER_RESUME:
      return {Kind::kResume, order.robot, order.client, 0};
    case msg::OrderKind::ORDER_ZONE:
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      break;
  }
  return {Kind::kZone, kAllRobots, order.client, order.zone_number};
}

bool OrderBook::has_room(const Order& order) const {
  const Kind kind = std::get<Kind>(place_of(order));
  if (kind == Kind::kDrive) return true;  // one for each robot and rank
  const auto first_hold = orders_.lower_bound({Kind::kHold, 0, 0, 0});
  const auto first_zone = orders_.lower_bound({Kind::kZone, 0, 0, 0});
  const bool is_zone = kind == Kind::kZone;
  const auto count =
      is_zone ? std::distance(first_zone, orders_.end()) : std::distance(first_hold, first_zone);
  const std::size_t limit = is_zone ? kMaxZones : kMaxHolds;
  return static_cast<std::size_t>(count) < (rank_of(order.client) > Rank::kClient ? 2 * limit : limit);
}

OrderBook::Outcome OrderBook::merge(const RememberedOrder& order) {
  const Place place = place_of(order.order);
  const auto known = orders_.find(place);
  if (known == orders_.end()) {
    if (!has_room(order.order)) return Outcome::kFull;
    orders_.emplace(place, order);
  } else if (is_later(order.order, known->second.order)) {
    known->second = order;
  } else if (is_later(known->second.order, order.order)) {
    return Outcome::kReplaced;
  } else if (is_further(order.progress, known->second.progress)) {
    known->second.progress = order.progress;
  } else {
    return Outcome::kKnown;
  }
  newest_number_ = std::max(newest_number_, order.order.number);
  return Outcome::kStored;
}

bool OrderBook::report(RobotId robot, ClientId client, OrderNumber number, const OrderProgress& progress) {
  if (number == 0) return false;  // the robot has no order
  bool is_new = false;
  for (std::size_t i = 0; i < kRanks; ++i) {
    const auto found = orders_.find(Place{Kind::kDrive, robot, static_cast<std::uint32_t>(i), 0});
    if (found == orders_.end()) continue;
    RememberedOrder& known = found->second;
    const bool is_reported = known.order.client == client && known.order.number == number;
    OrderProgress next = is_reported ? progress : known.progress;
    if (!is_reported && known.progress.state == msg::OrderState::ORDER_ARRIVED)
      next.state = msg::OrderState::ORDER_LEFT;
    if (!is_further(next, known.progress)) continue;
    known.progress = next;
    is_new = true;
  }
  return is_new;
}

bool OrderBook::has_resumed(ClientId client, RobotId robot, OrderNumber number) const {
  return std::ranges::any_of(std::array{robot, kAllRobots}, [&](RobotId scope) {
    const auto found = orders_.find(Place{Kind::kResume, scope, client, 0});
    return found != orders_.end() && found->second.order.number > number;
  });
}

bool OrderBook::is_held(RobotId robot) const {
  return std::any_of(orders_.lower_bound({Kind::kHold, 0, 0, 0}),
                     orders_.lower_bound({Kind::kResume, 0, 0, 0}), [&](const auto& entry) {
                       const Order& hold = entry.second.order;
                       return (hold.robot == robot || hold.robot == kAllRobots) &&
                              !has_resumed(hold.client, robot, hold.number) &&
                              !has_resumed(kOperator, robot, hold.number);
                     });
}

const RememberedOrder* OrderBook::drive_order(RobotId robot, Rank rank) const {
  const auto found = orders_.find(Place{Kind::kDrive, robot, static_cast<std::uint32_t>(rank), 0});
  return found == orders_.end() ? nullptr : &found->second;
}

const RememberedOrder* OrderBook::in_place_of(const Order& order) const {
  const auto found = orders_.find(place_of(order));
  return found == orders_.end() ? nullptr : &found->second;
}

std::vector<Order> OrderBook::zones() const {
  std::vector<Order> zones;
  for (auto i = orders_.lower_bound({Kind::kZone, 0, 0, 0}); i != orders_.end(); ++i) {
    if (i->second.order.kind == msg::OrderKind::ORDER_ZONE) zones.push_back(i->second.order);
  }
  return zones;
}

std::vector<RememberedOrder> OrderBook::all() const {
  std::vector<RememberedOrder> all;
  for (const auto& [place, order] : orders_) all.push_back(order);
  return all;
}

std::vector<RememberedOrder> OrderBook::missing_in(const OrderBook& other) const {
  std::vector<RememberedOrder> missing;
  for (const auto& [place, order] : orders_) {
    const auto known = other.orders_.find(place);
    const bool is_known =
        known != other.orders_.end() && !is_later(order.order, known->second.order) &&
        (is_later(known->second.order, order.order) || !is_further(order.progress, known->second.progress));
    if (!is_known) missing.push_back(order);
  }
  return missing;
}

}  // namespace sidestep
