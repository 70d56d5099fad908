// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/sim_bus.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace sidestep;

namespace {

const Time kBegin = time_from_ns(1'000'000'000);
constexpr Topic<msg::CoordinatorState> kReliable{
    {"reliable", "test", Qos::kEvent, false,
     message_type<msg::CoordinatorState>("sidestep::msg::CoordinatorState", 1024)}};

NetworkSpec delays(double min_s, double max_s, double loss = 0, double duplicate = 0) {
  return {loss, duplicate, from_seconds(min_s), from_seconds(max_s)};
}

msg::CoordinatorState numbered(std::uint64_t n) {
  msg::CoordinatorState state;
  state.epoch(n);
  return state;
}

/// Publishes 1 .. count, a millisecond apart, and returns what arrived, in order, with the delays.
struct Received {
  std::vector<std::uint64_t> numbers;
  std::vector<double> delays_s;
};
Received send_through(const NetworkSpec& network, std::uint64_t seed, std::uint64_t count,
                      const Topic<msg::CoordinatorState>& topic = topics::kCoordinator) {
  SimNetwork net(seed, kBegin, network);
  SimBus sender(net), receiver(net);
  auto writer = sender.advertise(topic);
  Received received;
  receiver.subscribe(
      topic, std::function([&](const msg::CoordinatorState& state) {
        received.numbers.push_back(state.epoch());
        received.delays_s.push_back(to_seconds(net.now() - time_from_ns(state.head().stamp_ns())));
      }));
  for (std::uint64_t n = 1; n <= count; ++n) {
    sender.at(kBegin + Duration{1'000'000} * n, [&, n] {
      auto state = numbered(n);
      writer.publish(state, sender.now());
    });
  }
  net.run_until(kBegin + Duration{1'000'000} * count + std::chrono::seconds(10));
  return received;
}

}  // namespace

TEST_CASE("timers fire in the order of their times, and in the order of their making at one time") {
  SimNetwork net(1, kBegin, {});
  SimBus bus(net);
  std::vector<int> order;
  bus.at(kBegin + Duration{20}, [&] { order.push_back(3); });
  bus.at(kBegin + Duration{10}, [&] { order.push_back(1); });
  bus.at(kBegin + Duration{10}, [&] { order.push_back(2); });
  bus.at(kBegin - Duration{10}, [&] { order.push_back(0); });
  net.run_until(kBegin + Duration{15});
  CHECK(order == std::vector<int>{0, 1, 2});
  CHECK(net.now() == kBegin + Duration{15});
  net.run_until(kBegin + Duration{30});
  CHECK(order == std::vector<int>{0, 1, 2, 3});
}

TEST_CASE("delays lie between their bounds and messages overtake each other") {
  const auto received = send_through(delays(0.01, 0.05), 2, 2000);
  REQUIRE(received.numbers.size() == 2000);
  const auto [least, most] = std::ranges::minmax(received.delays_s);
  CHECK(least >= 0.01);
  CHECK(least < 0.011);
  CHECK(most <= 0.05);
  CHECK(most > 0.049);
  CHECK_FALSE(std::ranges::is_sorted(received.numbers));
}

TEST_CASE("loss and duplicates have the probabilities asked for") {
  const auto received = send_through(delays(0, 0.001, 0.3, 0.2), 3, 20'000);
  const std::set<std::uint64_t> distinct(received.numbers.begin(), received.numbers.end());
  CHECK(static_cast<double>(distinct.size()) == Approx(20'000 * 0.7).epsilon(0.02));
  CHECK(static_cast<double>(received.numbers.size()) == Approx(20'000 * 0.7 * 1.2).epsilon(0.02));
}

TEST_CASE("events arrive all, once and in order, whatever happens to states") {
  const auto received = send_through(delays(0, 0.1, 0.5, 0.5), 4, 1000, kReliable);
  REQUIRE(received.numbers.size() == 1000);
  CHECK(std::ranges::is_sorted(received.numbers));
}

TEST_CASE("the same seed gives the same run and another seed another one") {
  const auto spec = delays(0, 0.15, 0.3, 0.1);
  const auto first = send_through(spec, 5, 500), again = send_through(spec, 5, 500),
             other = send_through(spec, 6, 500);
  CHECK(first.numbers == again.numbers);
  CHECK(first.delays_s == again.delays_s);
  CHECK(first.numbers != other.numbers);
}

TEST_CASE("a receiver gets the message as it was when it was sent") {
  SimNetwork net(7, kBegin, {});
  SimBus sender(net), receiver(net);
  auto writer = sender.advertise(topics::kCoordinator);
  std::uint64_t seen = 0;
  receiver.subscribe(topics::kCoordinator,
                     std::function([&](const msg::CoordinatorState& s) { seen = s.epoch(); }));
  auto state = numbered(11);
  writer.publish(state, sender.now());
  state.epoch(12);
  net.run_until(kBegin + std::chrono::seconds(1));
  CHECK(seen == 11);
}

TEST_CASE("channels of a topic that every robot has one of are separate") {
  SimNetwork net(8, kBegin, {});
  SimBus a(net), b(net);
  auto writer = a.advertise(topics::kVerdict, 3);
  int three = 0, four = 0;
  b.subscribe(topics::kVerdict, 3, std::function([&](const msg::Verdict&) { ++three; }));
  b.subscribe(topics::kVerdict, 4, std::function([&](const msg::Verdict&) { ++four; }));
  msg::Verdict verdict;
  writer.publish(verdict, a.now());
  net.run_until(kBegin + std::chrono::seconds(1));
  CHECK(three == 1);
  CHECK(four == 0);
}

TEST_CASE("a process that is killed gets nothing any more, and what it has sent still arrives") {
  SimNetwork net(9, kBegin, delays(0.1, 0.1));
  SimBus witness(net);
  int heard = 0, fired = 0, delivered = 0;
  witness.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState&) { ++heard; }));
  {
    SimBus victim(net);
    victim.at(kBegin + std::chrono::seconds(1), [&] { ++fired; });
    victim.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState&) { ++delivered; }));
    auto writer = victim.advertise(topics::kCoordinator);
    auto state = numbered(1);
    writer.publish(state, victim.now());
  }
  net.run_until(kBegin + std::chrono::seconds(2));
  CHECK(heard == 1);
  CHECK(fired == 0);
  CHECK(delivered == 0);
}
