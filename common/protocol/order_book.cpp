// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/order_book.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace sidestep {
namespace {

/// Whether the first order is later. Orders of different clients may have equal numbers.
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

void OrderBook::count(const Place& place, const Order& order, bool is_added) {
  const auto rank = static_cast<std::size_t>(rank_of(order.client));
  const auto change = [&](std::size_t& counter) { counter += is_added ? std::size_t{1} : ~std::size_t{0}; };
  const auto age = [&](Lifted& lifted) {
    if (is_added)
      lifted.by_age.emplace(order.number, place);
    else
      lifted.by_age.erase({order.number, place});
  };
  switch (order.kind) {
    case msg::OrderKind::ORDER_HOLD:
      return change(holds_[rank]);
    case msg::OrderKind::ORDER_ZONE:
      return change(zones_[rank]);
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      return age(removals_);
    case msg::OrderKind::ORDER_RESUME:
      if (rank_of(order.client) == Rank::kClient) age(resumes_);
      return;
    case msg::OrderKind::ORDER_GO:
    case msg::OrderKind::ORDER_CANCEL:
      return;
  }
}

void OrderBook::store(const Place& place, const RememberedOrder& order) {
  const auto known = orders_.find(place);
  if (known != orders_.end()) remove(known);
  orders_.emplace(place, order);
  count(place, order.order, true);
}

void OrderBook::remove(std::map<Place, RememberedOrder>::iterator entry) {
  count(entry->first, entry->second.order, false);
  orders_.erase(entry);
}

bool OrderBook::has_room(const Order& order) const {
  const Rank rank = rank_of(order.client);
  const auto known = orders_.find(place_of(order));
  const bool stands = known != orders_.end() && known->second.order.kind == order.kind;
  if (stands) return true;  // the order in this place is replaced
  if (order.kind == msg::OrderKind::ORDER_ZONE) return zones_[static_cast<std::size_t>(rank)] < kMaxZones;
  if (order.kind == msg::OrderKind::ORDER_RESUME)
    return rank != Rank::kClient || !is_exception(order) || exception_count() < kMaxExceptions;
  const bool is_bounded = order.kind == msg::OrderKind::ORDER_HOLD && rank == Rank::kClient;
  return !is_bounded || holds_[static_cast<std::size_t>(rank)] < kMaxHolds;
}

bool OrderBook::may_be_forgotten(const Order& order) const {
  if (orders_.contains(place_of(order))) return false;
  if (order.kind == msg::OrderKind::ORDER_ZONE) return order.number <= removals_.forgotten_number;
  return order.kind == msg::OrderKind::ORDER_HOLD && rank_of(order.client) == Rank::kClient &&
         order.number <= resumes_.forgotten_number;
}

bool OrderBook::is_redundant(const Order& resume) const {
  const Place own = place_of(resume);
  return std::ranges::any_of(std::array{resume.robot, kAllRobots}, [&](RobotId scope) {
    return std::ranges::any_of(std::array{resume.client, kOperator}, [&](ClientId client) {
      const Place place{Kind::kResume, scope, client, 0};
      const auto found = orders_.find(place);
      return place != own && found != orders_.end() && found->second.order.number >= resume.number;
    });
  });
}

bool OrderBook::ends_any_hold(const Order& resume) const {
  const bool is_of_operator = resume.client == kOperator;
  const auto is_lifted_by = [&](const auto& entry) {
    const Order& hold = entry.second.order;
    return hold.number < resume.number && (is_of_operator || hold.client == resume.client);
  };
  const auto holds_of = [&](RobotId first, RobotId last) {
    return std::any_of(orders_.lower_bound({Kind::kHold, first, 0, 0}),
                       orders_.upper_bound({Kind::kHold, last, ~0U, ~0U}), is_lifted_by);
  };
  if (resume.robot == kAllRobots) return holds_of(0, kAllRobots);
  return holds_of(resume.robot, resume.robot) || holds_of(kAllRobots, kAllRobots);
}

bool OrderBook::is_exception(const Order& resume) const {
  if (resume.robot == kAllRobots) return false;
  const auto all = orders_.find(Place{Kind::kHold, kAllRobots, resume.client, 0});
  return all != orders_.end() && all->second.order.number < resume.number;
}

std::size_t OrderBook::exception_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(
      resumes_.by_age, [&](const auto& age) { return is_exception(orders_.at(age.second).order); }));
}

void OrderBook::clear_lifted_by(const Order& resume) {
  const Place own = place_of(resume);
  const bool is_for_all = resume.robot == kAllRobots;
  const auto clear = [&](Kind kind, RobotId first, RobotId last) {
    auto entry = orders_.lower_bound({kind, first, 0, 0});
    const auto end = orders_.upper_bound({kind, last, ~0U, ~0U});
    while (entry != end) {
      const Order& order = entry->second.order;
      const bool is_lifted =
          entry->first != own && (resume.client == kOperator || order.client == resume.client) &&
          (kind == Kind::kHold ? order.number < resume.number : order.number <= resume.number);
      const auto next = std::next(entry);
      if (is_lifted) remove(entry);
      entry = next;
    }
  };
  clear(Kind::kHold, is_for_all ? 0 : resume.robot, resume.robot);
  clear(Kind::kResume, is_for_all ? 0 : resume.robot, resume.robot);
}

// Keeps exceptions: if an exception were forgotten, its robot would be held again.
void OrderBook::forget_oldest_resumes() {
  if (resumes_.by_age.size() <= kMaxResumes) return;
  const std::size_t exceptions = exception_count();
  const auto forget = [&](std::size_t excess, bool are_exceptions) {
    for (auto next = resumes_.by_age.begin(); excess > 0;) {
      const auto [number, place] = *next++;
      const auto entry = orders_.find(place);
      if (is_exception(entry->second.order) != are_exceptions) continue;
      resumes_.forgotten_number = std::max(resumes_.forgotten_number, number);
      remove(entry);
      --excess;
    }
  };
  const auto beyond = [](std::size_t count, std::size_t limit) { return count > limit ? count - limit : 0; };
  forget(beyond(resumes_.by_age.size() - exceptions, kMaxResumes), false);
  forget(beyond(exceptions, kMaxMergedExceptions), true);
}

void OrderBook::forget_oldest_removals() {
  while (removals_.by_age.size() > kMaxRemovals) {
    const auto oldest = removals_.by_age.begin();
    removals_.forgotten_number = std::max(removals_.forgotten_number, oldest->first);
    remove(orders_.find(oldest->second));
  }
}

bool OrderBook::knows(const Order& order) const {
  const auto known = orders_.find(place_of(order));
  if (known != orders_.end() && !is_later(order, known->second.order)) return true;
  switch (order.kind) {
    case msg::OrderKind::ORDER_HOLD:
      return is_lifted(order);
    case msg::OrderKind::ORDER_RESUME: {
      const bool is_forgotten =
          rank_of(order.client) == Rank::kClient && order.number <= resumes_.forgotten_number;
      return is_redundant(order) || (is_forgotten && !ends_any_hold(order));
    }
    case msg::OrderKind::ORDER_REMOVE_ZONE:
      return known == orders_.end() && order.number <= removals_.forgotten_number;
    case msg::OrderKind::ORDER_GO:
    case msg::OrderKind::ORDER_CANCEL:
    case msg::OrderKind::ORDER_ZONE:
      break;
  }
  return false;
}

OrderBook::Outcome OrderBook::merge(const RememberedOrder& order) {
  newest_number_ = std::max(newest_number_, order.order.number);
  const Place place = place_of(order.order);
  const auto known = orders_.find(place);
  if (knows(order.order)) {
    const bool is_replaced = order.order.kind == msg::OrderKind::ORDER_HOLD && is_lifted(order.order);
    if (is_replaced || (known != orders_.end() && is_later(known->second.order, order.order)))
      return Outcome::kReplaced;
    if (known == orders_.end() || !is_further(order.progress, known->second.progress)) return Outcome::kKnown;
    known->second.progress = order.progress;
    return Outcome::kStored;
  }
  store(place, order);
  if (order.order.kind == msg::OrderKind::ORDER_RESUME) {
    clear_lifted_by(order.order);
    forget_oldest_resumes();
  }
  if (order.order.kind == msg::OrderKind::ORDER_REMOVE_ZONE) forget_oldest_removals();
  return Outcome::kStored;
}

OrderBook::Outcome OrderBook::admit(const Order& order) {
  if (!knows(order)) {
    if (may_be_forgotten(order)) return Outcome::kReplaced;
    if (!has_room(order)) return Outcome::kFull;
  }
  return merge({order});
}

bool OrderBook::report(RobotId robot, ClientId client, OrderNumber number, const OrderProgress& progress) {
  if (number == 0) return false;  // 0 means that the robot has no order
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

bool OrderBook::is_lifted(const Order& hold) const {
  return has_resumed(hold.client, hold.robot, hold.number) || has_resumed(kOperator, hold.robot, hold.number);
}

bool OrderBook::contradicts(const Order& order) const {
  if (knows(order)) return false;
  if (order.kind == msg::OrderKind::ORDER_RESUME) return ends_any_hold(order);
  return orders_.contains(place_of(order));  // an earlier order, since this order is not known
}

bool OrderBook::stands(const Order& order) const {
  const auto known = orders_.find(place_of(order));
  return known != orders_.end() && known->second.order.kind == order.kind &&
         !is_later(known->second.order, order) && !is_later(order, known->second.order);
}

bool OrderBook::holds_robot(const Order& hold, RobotId robot) const {
  return !has_resumed(hold.client, robot, hold.number) && !has_resumed(kOperator, robot, hold.number);
}

bool OrderBook::is_held(RobotId robot) const {
  return std::ranges::any_of(std::array{robot, kAllRobots}, [&](RobotId scope) {
    return std::any_of(orders_.lower_bound({Kind::kHold, scope, 0, 0}),
                       orders_.upper_bound({Kind::kHold, scope, ~0U, ~0U}),
                       [&](const auto& entry) { return holds_robot(entry.second.order, robot); });
  });
}

std::vector<Order> OrderBook::holds_of(RobotId robot) const {
  std::vector<Order> found = holds();
  std::erase_if(found, [&](const Order& hold) {
    const bool concerns = hold.robot == robot || hold.robot == kAllRobots;
    return !concerns || !holds_robot(hold, robot);
  });
  return found;
}

std::vector<Order> OrderBook::holds() const {
  std::vector<Order> holds;
  const auto end = orders_.upper_bound({Kind::kHold, kAllRobots, ~0U, ~0U});
  for (auto hold = orders_.lower_bound({Kind::kHold, 0, 0, 0}); hold != end; ++hold)
    holds.push_back(hold->second.order);
  return holds;
}

const RememberedOrder* OrderBook::drive_order(RobotId robot, Rank rank) const {
  const auto found = orders_.find(Place{Kind::kDrive, robot, static_cast<std::uint32_t>(rank), 0});
  return found == orders_.end() ? nullptr : &found->second;
}

const RememberedOrder* OrderBook::occupant_of(const Order& order) const {
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
    const bool knows_less = known != other.orders_.end() && !is_later(known->second.order, order.order) &&
                            is_further(order.progress, known->second.progress);
    if (knows_less || !other.knows(order.order)) missing.push_back(order);
  }
  return missing;
}

}  // namespace sidestep
