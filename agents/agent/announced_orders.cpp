// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/announced_orders.hpp"

#include <algorithm>
#include <functional>

namespace sidestep {
namespace {

// More pages of changes than this are merged into one page.
constexpr std::size_t kMaxPages = msg::MAX_MEMORY_ORDERS * 8;

}  // namespace

AnnouncedOrders::AnnouncedOrders(std::vector<RobotId> roster) : roster_(std::move(roster)) {
  std::ranges::sort(roster_);
}

void AnnouncedOrders::on_page(std::shared_ptr<const OrderPage> page, const OrderBook& own) {
  if (page->count > 0)
    add(std::move(page), own);
  else
    add_changes(std::move(page), own);
}

bool AnnouncedOrders::is_on_roster(const Order& order) const {
  return roster_.empty() || order.robot == kAllRobots || std::ranges::binary_search(roster_, order.robot);
}

void AnnouncedOrders::add_changes(std::shared_ptr<const OrderPage> page, const OrderBook& own) {
  if (page->orders.empty()) return;
  std::erase_if(fully_announced_by_,
                [&](const auto& coordinator) { return coordinator.first != page->process; });
  changes_.push_back(std::move(page));
  if (changes_.size() <= kMaxPages) return;
  OrderPage together;
  together.orders = with(own).all();
  changes_.assign(1, std::make_shared<const OrderPage>(std::move(together)));
  latest_memory_.clear();
}

void AnnouncedOrders::add(std::shared_ptr<const OrderPage> page, const OrderBook& own) {
  Round& round = rounds_[page->process];
  if (page->index == 0) round.clear();
  if (page->index != round.size()) return;
  const bool is_last = page->index + 1 == page->count;
  round.push_back(std::move(page));
  if (!is_last) return;
  const Round whole = std::exchange(round, {});
  is_known_ |= whole.back()->is_complete;
  compare(whole, own);
}

void AnnouncedOrders::compare(const Round& round, const OrderBook& own) {
  const OrderPage& last = *round.back();
  const bool is_same = changes_.empty() && !has_progressed_ &&
                       std::ranges::equal(round, latest_memory_, [](const auto& a, const auto& b) {
                         return have_same_orders(*a, *b);
                       });
  if (is_same) {
    fully_announced_by_[last.process] = last.incarnation;
    missing_.clear();
    return;
  }
  const OrderBook remembered = with(own);
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
  if (is_new) fully_announced_by_.clear();
  if (std::ranges::any_of(missing_, lacks))
    fully_announced_by_.erase(last.process);
  else
    fully_announced_by_[last.process] = last.incarnation;
  // Orders that this coordinator lacks are kept.
  latest_memory_ = round;
  changes_.clear();
  has_progressed_ = false;
  if (missing_.empty()) return;
  OrderPage kept;
  kept.orders = missing_;
  changes_.push_back(std::make_shared<const OrderPage>(std::move(kept)));
}

bool AnnouncedOrders::has_announced_all_orders(std::uint32_t coordinator, Incarnation incarnation) const {
  const auto found = fully_announced_by_.find(coordinator);
  return found != fully_announced_by_.end() && found->second == incarnation;
}

template <typename Use>
void AnnouncedOrders::for_each(Use use) const {
  for (const auto& pages : {std::cref(latest_memory_), std::cref(changes_)}) {
    for (const auto& page : pages.get()) {
      for (const RememberedOrder& order : page->orders) use(order);
    }
  }
}

OrderBook AnnouncedOrders::with(const OrderBook& own) const {
  OrderBook whole;
  for_each([&](const RememberedOrder& order) {
    if (is_on_roster(order.order)) whole.merge(order);
  });
  for (const RememberedOrder& order : own.all()) whole.merge(order);
  return whole;
}

OrderBook AnnouncedOrders::of(RobotId robot) const {
  OrderBook book;
  for_each([&](const RememberedOrder& order) {
    if (order.order.robot == robot || order.order.robot == kAllRobots) book.merge(order);
  });
  return book;
}

}  // namespace sidestep
