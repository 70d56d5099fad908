// SPDX-License-Identifier: Apache-2.0
// Ten thousand orders a second, with real processes.
#include <chrono>
#include <fmt/format.h>
#include <limits>
#include <signal.h>

#include "common/client/order_client.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/faults/process_usage.hpp"

namespace sidestep::order_flood_test {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kPerSecond = 10'000;
// Maximum growth of a process. Storing the orders of the shortest flood would need three times as much.
constexpr double kMaxGrowth_mb = 6;

std::string waiting_robots() {
  std::string text =
      "field: {length_m: 6, width_m: 5}\nobstacles: [{centre_m: [0, 0], radius_m: 0.3}]\nrobots:\n";
  for (int i = 0; i < 4; ++i) text += fmt::format("  - {{id: {}, start_m: [-2, {}]}}\n", i, -1.5 + i);
  return text;
}

/// A random order from one of two hostile clients. Most fields are valid, but each is sometimes absurd.
msg::Order hostile_order(Rng& rng, Time now) {
  const auto sometimes = [&](double usual, double absurd) { return rng.below(10) == 0 ? absurd : usual; };
  msg::Order order;
  order.header().sender(1'000'001 + static_cast<std::uint32_t>(rng.below(2)));
  // The flood does not affect robot 0, which must carry out its order.
  order.robot(
      static_cast<std::uint32_t>(sometimes(1.0 + static_cast<double>(rng.below(3)), 4e9 * rng.uniform())));
  order.terms().order_kind(static_cast<msg::OrderKind>(rng.below(5)));
  if (order.terms().order_kind() == msg::OrderKind::ORDER_ZONE) order.robot(kAllRobots);
  order.terms().order_number(static_cast<OrderNumber>(to_ns(now)) - rng.below(1'000'000'000));
  order.terms().zone(static_cast<std::uint32_t>(rng.below(1'000'000)));
  order.terms().zone_radius_m(sometimes(0.05, -1));
  order.poses().resize(rng.below(4));
  for (msg::OrderPose& pose : order.poses()) {
    pose.x_m(sometimes(rng.uniform(1.8, 3.3), std::numeric_limits<double>::quiet_NaN()));
    pose.y_m(sometimes(rng.uniform(-2.4, 2.4), 1e300));
    pose.speed_limit_mps(sometimes(0, -std::numeric_limits<double>::infinity()));
  }
  return order;
}

void run_flood(Duration duration) {
  LaunchedRun run(waiting_robots(),
                  {"--seconds", std::to_string(static_cast<int>(to_seconds(duration)) + 60)});
  Rng rng(1);
  std::map<msg::OrderResult, int> results;
  run.bus().subscribe(topics::kOrderAnswer,
                      [&](const msg::OrderAnswer& answer) { ++results[answer.result()]; });
  Writer<msg::Order> writer = run.bus().advertise(topics::kOrder);
  OrderClient client(run.bus(), static_cast<ClientId>(Sender::kOperator));
  const OrderHandle warm_up = client.go(0, {{{-2, 2}}});
  REQUIRE(run.wait_until([&] { return client.find(warm_up)->phase == OrderPhase::kArrived; }));
  int sent = 0;
  const auto flood = [&](Duration length) {
    const Time begin = run.bus().now();
    int count = 0;
    REQUIRE(run.wait_until([&] {
      const Duration elapsed = run.bus().now() - begin;
      for (; count < to_seconds(elapsed) * kPerSecond; ++count) {
        msg::Order order = hostile_order(rng, run.bus().now());
        writer.publish(order, run.bus().now());
      }
      return elapsed > length;
    }));
    sent += count;
  };
  flood(seconds(5));
  const auto before = usage_of(run);
  const OrderHandle into_obstacle = client.go(0, {{{0, 0}}});
  for (Duration left = duration; left > Duration{0}; left -= seconds(30))
    flood(std::min<Duration>(left, seconds(30)));
  const auto after = usage_of(run);
  INFO(run.output());
  for (const auto& [process, usage] : before) {
    const double growth_mb = after.at(process).memory_mb - usage.memory_mb;
    WARN(process << ": " << usage.memory_mb << " MB, grown by " << growth_mb << " MB");
    CHECK(growth_mb < kMaxGrowth_mb);
  }
  WARN(sent << " orders; answers: " << results[msg::OrderResult::RESULT_REMEMBERED] << " remembered, "
            << results[msg::OrderResult::RESULT_REPLACED] << " replaced, "
            << results[msg::OrderResult::RESULT_MALFORMED] << " malformed, "
            << results[msg::OrderResult::RESULT_UNKNOWN_ROBOT] << " for unknown robots, "
            << results[msg::OrderResult::RESULT_OUTSIDE_FIELD] << " outside the field, "
            << results[msg::OrderResult::RESULT_TOO_MANY] << " too many");
  CHECK(results.size() >= 4);
  CHECK(run.wait_until([&] { return client.find(into_obstacle)->phase == OrderPhase::kBlocked; }));
  const OrderHandle last = client.go(0, {{{-2, 1.8}}});
  CHECK(run.wait_until([&] { return client.find(last)->phase == OrderPhase::kArrived; }));
  REQUIRE(kill(run.pid(), SIGINT) == 0);
  CHECK(run.wait_for_end() != "");
  CHECK(run.report()["contacts"] == 0);
  CHECK(run.report()["audit"]["violations"] == 0);
}

TEST_CASE("ten thousand orders a second over DDS are answered without filling memory", "[both-cores]") {
  run_flood(seconds(8));
}

TEST_CASE("ten thousand orders a second over DDS for two minutes do not fill memory", "[.long][slow]") {
  run_flood(std::chrono::minutes(2));
}

}  // namespace sidestep::order_flood_test
