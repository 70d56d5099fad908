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
  /// Of the orders that do not change any more, only so many are remembered, the latest.
  static constexpr std::size_t kMaxFinal = 1000;

  /// A new order, in the phase kSent.
  OrderId add();
  /// With `is_final` the order does not change any more. Whether it has changed now.
  bool update(OrderId order, const OrderState& state, bool is_final);
  /// nullopt: unknown or forgotten.
  std::optional<OrderState> find(OrderId order) const;
  /// The order's state when it is over, or after `timeout`.
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
