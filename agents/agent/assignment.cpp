// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/assignment.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

namespace sidestep {
namespace {

constexpr std::array kFromHighestRank{Rank::kOperator, Rank::kReferee, Rank::kClient, Rank::kScenario};

// If there are more pages, they are merged into one.
constexpr std::size_t kMaxPages = msg::MAX_MEMORY_ORDERS * 8;

bool is_zone(const Order& order) {
  return order.kind == msg::OrderKind::ORDER_ZONE || order.kind == msg::OrderKind::ORDER_REMOVE_ZONE;
}

bool is_to_do(const RememberedOrder* order) {
  return order && order->order.kind == msg::OrderKind::ORDER_GO && !order->progress.is_finished();
}

}  // namespace

Assignment::Assignment(RobotId robot, std::vector<Goal> scenario_goals, std::vector<RobotId> roster)
    : robot_(robot), scenario_goals_(std::move(scenario_goals)), roster_(std::move(roster)) {
  std::ranges::sort(roster_);
}

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
  else
    add_changes(std::move(page));
  if (!concerns_robot) return;
  is_held_ = book_.is_held(robot_);
  choose();
}

bool Assignment::is_on_roster(const Order& order) const {
  return roster_.empty() || order.robot == kAllRobots || std::ranges::binary_search(roster_, order.robot);
}

void Assignment::add_changes(std::shared_ptr<const OrderPage> page) {
  if (page->orders.empty()) return;
  std::erase_if(told_by_, [&](const auto& coordinator) { return coordinator.first != page->process; });
  changes_.push_back(std::move(page));
  if (changes_.size() <= kMaxPages) return;
  OrderPage together;
  together.orders = all();
  changes_.assign(1, std::make_shared<const OrderPage>(std::move(together)));
  told_.clear();
}

void Assignment::add(std::shared_ptr<const OrderPage> page) {
  Round& round = rounds_[page->process];
  if (page->index == 0) round.clear();
  if (page->index != round.size()) return;
  const bool is_last = page->index + 1 == page->count;
  round.push_back(std::move(page));
  if (!is_last) return;
  const Round whole = std::exchange(round, {});
  is_known_ |= whole.back()->is_complete;
  compare(whole);
}

void Assignment::compare(const Round& round) {
  const OrderPage& last = *round.back();
  const bool is_same =
      changes_.empty() && !has_progressed_ &&
      std::ranges::equal(round, told_, [](const auto& a, const auto& b) { return have_same_orders(*a, *b); });
  if (is_same) {
    told_by_[last.process] = last.incarnation;
    missing_.clear();
    return;
  }
  const OrderBook remembered = whole_book();
  OrderBook told, both = remembered;
  bool is_new = false;
  for (const auto& page : round) {
    for (const RememberedOrder& order : page->orders) {
      told.merge(order);
      is_new |= !remembered.knows(order.order);
      both.merge(order);
    }
  }
  missing_ = both.missing_in(told);
  const auto lacks = [&](const RememberedOrder& order) { return !told.knows(order.order); };
  if (is_new) told_by_.clear();
  if (std::ranges::any_of(missing_, lacks))
    told_by_.erase(last.process);
  else
    told_by_[last.process] = last.incarnation;
  // Orders that this coordinator lacks are kept.
  told_ = round;
  changes_.clear();
  has_progressed_ = false;
  if (missing_.empty()) return;
  OrderPage kept;
  kept.orders = missing_;
  changes_.push_back(std::make_shared<const OrderPage>(std::move(kept)));
}

bool Assignment::is_told_by(std::uint32_t coordinator, Incarnation incarnation) const {
  const auto found = told_by_.find(coordinator);
  return found != told_by_.end() && found->second == incarnation;
}

template <typename Use>
void Assignment::for_each(Use use) const {
  for (const auto& pages : {std::cref(told_), std::cref(changes_)}) {
    for (const auto& page : pages.get()) {
      for (const RememberedOrder& order : page->orders) use(order);
    }
  }
}

OrderBook Assignment::whole_book() const {
  OrderBook whole;
  for_each([&](const RememberedOrder& order) {
    if (is_on_roster(order.order)) whole.merge(order);
  });
  for (const RememberedOrder& order : book_.all()) whole.merge(order);
  return whole;
}

OrderReport Assignment::report() const {
  OrderReport report{robot_, client_, number_, progress_};
  report.is_held = is_held_;
  return report;
}

bool Assignment::yields_to(const PassageContender& other, Time t, Duration period) const {
  return may_pass_first(other, {robot_, number_}, t, period);
}

OtherAssignment Assignment::other(RobotId robot) const {
  OrderBook book;
  for_each([&](const RememberedOrder& order) {
    if (order.order.robot == robot || order.order.robot == kAllRobots) book.merge(order);
  });
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
  // An earlier agent of this robot has finished an order, and the robot must stay there.
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
  has_progressed_ |= book_.report(robot_, client_, number_, progress_);
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
  has_progressed_ |= book_.report(robot_, client_, number_, progress_);
}

}  // namespace sidestep
