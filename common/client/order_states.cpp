// SPDX-License-Identifier: Apache-2.0
#include "common/client/order_states.hpp"

#include <algorithm>

namespace sidestep::client {

OrderId OrderStates::add() {
  const std::lock_guard lock(mutex_);
  entries_[++last_] = {};
  return last_;
}

bool OrderStates::update(OrderId order, const OrderState& state, bool is_final) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(order);
  if (found == entries_.end() || found->second.is_final) return false;
  const bool has_changed = !(found->second.state == state);
  found->second = {state, is_final};
  changed_.notify_all();
  if (!is_final) return has_changed;
  final_.push_back(order);
  if (final_.size() > kMaxFinal) {
    entries_.erase(final_.front());
    final_.pop_front();
  }
  return has_changed;
}

std::optional<OrderState> OrderStates::find(OrderId order) const {
  const std::lock_guard lock(mutex_);
  return find_locked(order);
}

std::optional<OrderState> OrderStates::wait(OrderId order, std::chrono::nanoseconds timeout) const {
  // A deadline farther away would overflow.
  constexpr std::chrono::nanoseconds kMaxTimeout = std::chrono::hours(24 * 365);
  const auto deadline = std::chrono::steady_clock::now() + std::min(timeout, kMaxTimeout);
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, deadline, [&] {
    const auto state = find_locked(order);
    return !state || state->is_over;
  });
  return find_locked(order);
}

std::optional<OrderState> OrderStates::find_locked(OrderId order) const {
  const auto found = entries_.find(order);
  return found == entries_.end() ? std::nullopt : std::optional(found->second.state);
}

}  // namespace sidestep::client
