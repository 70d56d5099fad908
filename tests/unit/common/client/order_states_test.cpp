// SPDX-License-Identifier: Apache-2.0
#include "common/client/order_states.hpp"

#include <chrono>
#include <thread>
#include <vector>

#include "tests/catch.hpp"

namespace sidestep::client::order_states_test {

constexpr OrderState kArrived{OrderPhase::kArrived, Refusal::kNone, 0, true};
constexpr OrderState kDriving{OrderPhase::kDriving, Refusal::kNone, 0, false};
constexpr std::chrono::minutes kLong{1};

TEST_CASE("the state of an order changes until the order is over") {
  OrderStates states;
  const OrderId order = states.add();
  CHECK(states.find(order) == OrderState{});
  CHECK(states.update(order, kDriving, false));
  CHECK_FALSE(states.update(order, kDriving, false));
  CHECK(states.update(order, kArrived, true));
  CHECK_FALSE(states.update(order, kDriving, false));
  CHECK(states.find(order) == kArrived);
  CHECK_FALSE(states.find(order + 1).has_value());
  CHECK_FALSE(states.update(order + 1, kDriving, false));
}

TEST_CASE("a thread waits until its order is over, regardless of other orders") {
  OrderStates states;
  const OrderId order = states.add(), other = states.add();
  std::optional<OrderState> seen;
  std::thread waiting([&] { seen = states.wait(order, kLong); });
  states.update(other, kArrived, true);
  states.update(order, kDriving, false);
  states.update(order, kArrived, true);
  waiting.join();
  CHECK(seen == kArrived);
}

TEST_CASE("an order's state may change after waiting threads have returned until the state is final") {
  OrderStates states;
  const OrderId zone = states.add();
  const OrderState accepted{OrderPhase::kAccepted, Refusal::kNone, 0, true};
  const OrderState replaced{OrderPhase::kReplaced, Refusal::kNone, 0, true};
  CHECK(states.update(zone, accepted, false));
  CHECK(states.wait(zone, kLong) == accepted);
  CHECK(states.update(zone, replaced, true));
  CHECK_FALSE(states.update(zone, accepted, false));
  CHECK(states.find(zone) == replaced);
}

TEST_CASE("a waiting thread returns at its timeout, whether that is extremely short or extremely long") {
  OrderStates states;
  const OrderId order = states.add();
  states.update(order, kDriving, false);
  CHECK(states.wait(order, std::chrono::milliseconds(1)) == kDriving);
  CHECK(states.wait(order, std::chrono::nanoseconds::min()) == kDriving);
  CHECK_FALSE(states.wait(order + 1, kLong).has_value());
  states.update(order, kArrived, true);
  CHECK(states.wait(order, std::chrono::nanoseconds::max()) == kArrived);
}

TEST_CASE("all orders that may still change are remembered, but only the latest final orders") {
  OrderStates states;
  const OrderId open = states.add();
  std::vector<OrderId> orders;
  for (std::size_t i = 0; i <= OrderStates::kMaxFinal; ++i) {
    orders.push_back(states.add());
    states.update(orders.back(), kArrived, true);
  }
  CHECK_FALSE(states.find(orders[0]).has_value());
  CHECK(states.find(orders[1]) == kArrived);
  CHECK(states.find(orders.back()) == kArrived);
  CHECK(states.find(open) == OrderState{});
}

}  // namespace sidestep::client::order_states_test
