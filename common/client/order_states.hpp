// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

#include "common/client/client.hpp"

namespace sidestep::client {

/// The states of a client's orders, for threads that wait for changes. Thread-safe.
class OrderStates {
 public:
  /// Number of final orders that are remembered; the oldest are forgotten first.
  static constexpr std::size_t kMaxFinal = 1000;

  /// Adds an order in the phase kSent.
  OrderId add();
  /// Updates an order's state. With `is_final` the state can no longer change. Returns whether the state has
  /// changed.
  bool update(OrderId order, const OrderState& state, bool is_final);
  /// nullopt if the order is unknown or forgotten.
  std::optional<OrderState> find(OrderId order) const;
  /// Waits until the order is over or `timeout` has passed, and returns its state.
  std::optional<OrderState> wait(OrderId order, std::chrono::nanoseconds timeout) const;

 private:
  struct Entry {
    OrderState state{};
    bool is_final = false;
  };
  std::optional<OrderState> find_locked(OrderId order) const;

  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  OrderId last_ = 0;
  std::map<OrderId, Entry> entries_;
  std::deque<OrderId> final_;
};

}  // namespace sidestep::client
