// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/bus.hpp"

#include <algorithm>
#include <set>

#include "common/messaging/topic_access.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::bus_test {

const Time kBegin = time_from_ns(1'000'000'000);
constexpr Topic<msg::CoordinatorState> kReliable{
    {"reliable",
     Role::kCoordinator,
     {},
     Qos::kEvent,
     false,
     false,
     message_type<msg::CoordinatorState>("sidestep::msg::CoordinatorState", 1024)}};

NetworkSpec delays(double min_s, double max_s, double loss = 0, double duplicate = 0) {
  return {loss, duplicate, from_seconds(min_s), from_seconds(max_s)};
}

msg::CoordinatorState numbered(std::uint64_t n) {
  msg::CoordinatorState state;
  state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  state.epoch(n);
  return state;
}

/// The messages that arrived, in order, with their delays.
struct Received {
  std::vector<std::uint64_t> numbers;
  std::vector<double> delays_s;
};
/// Publishes the numbers from 1 to `count`, a millisecond apart, and returns what arrives.
Received received_over(const NetworkSpec& network, std::uint64_t seed, std::uint64_t count,
                       const Topic<msg::CoordinatorState>& topic = topics::kCoordinator) {
  SimNetwork net(seed, kBegin, network);
  SimBus sender(net), receiver(net);
  auto writer = sender.advertise(topic);
  Received received;
  receiver.subscribe(
      topic, std::function([&](const msg::CoordinatorState& state) {
        received.numbers.push_back(state.epoch());
        received.delays_s.push_back(to_seconds(net.now() - time_from_ns(state.header().stamp_ns())));
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

TEST_CASE("timers fire in order of time, and at equal times in order of creation") {
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

TEST_CASE("delays lie within their bounds and messages overtake each other") {
  const auto received = received_over(delays(0.01, 0.05), 2, 2000);
  REQUIRE(received.numbers.size() == 2000);
  const auto [min, max] = std::ranges::minmax(received.delays_s);
  CHECK(min >= 0.01);
  CHECK(min < 0.011);
  CHECK(max <= 0.05);
  CHECK(max > 0.049);
  CHECK_FALSE(std::ranges::is_sorted(received.numbers));
}

TEST_CASE("losses and duplicates have the specified probabilities") {
  const auto received = received_over(delays(0, 0.001, 0.3, 0.2), 3, 20'000);
  const std::set<std::uint64_t> distinct(received.numbers.begin(), received.numbers.end());
  CHECK(static_cast<double>(distinct.size()) == Approx(20'000 * 0.7).epsilon(0.02));
  CHECK(static_cast<double>(received.numbers.size()) == Approx(20'000 * 0.7 * 1.2).epsilon(0.02));
}

TEST_CASE("all events arrive once and in order on a network that loses and duplicates states") {
  const auto seed = GENERATE(range(1u, 101u));
  CAPTURE(seed);
  const auto received = received_over(delays(0, 0.1, 0.5, 0.5), seed, kEventDepth, kReliable);
  REQUIRE(received.numbers.size() == kEventDepth);
  CHECK(std::ranges::is_sorted(received.numbers));
}

TEST_CASE("the same seed gives the same run and a different seed a different run") {
  const auto spec = delays(0, 0.15, 0.3, 0.1);
  const auto first = received_over(spec, 5, 500), again = received_over(spec, 5, 500),
             other = received_over(spec, 6, 500);
  CHECK(first.numbers == again.numbers);
  CHECK(first.delays_s == again.delays_s);
  CHECK(first.numbers != other.numbers);
}

TEST_CASE("changing a message after sending it does not affect the receiver") {
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

TEST_CASE("the channels of a per-robot topic are separate") {
  SimNetwork net(8, kBegin, {});
  SimBus a(net), b(net);
  auto writer = a.advertise(topics::kVerdict, 3);
  int three = 0, four = 0;
  b.subscribe(topics::kVerdict, 3, std::function([&](const msg::Verdict&) { ++three; }));
  b.subscribe(topics::kVerdict, 4, std::function([&](const msg::Verdict&) { ++four; }));
  msg::Verdict verdict;
  verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  writer.publish(verdict, a.now());
  net.run_until(kBegin + std::chrono::seconds(1));
  CHECK(three == 1);
  CHECK(four == 0);
}

TEST_CASE("a subscription gets no messages from a sender that may not write the topic") {
  const auto of = [](Sender sender, std::uint32_t number = 0) {
    return static_cast<std::uint32_t>(sender) + number;
  };
  const std::vector<std::uint32_t> senders{0,
                                           kMaxRobots - 1,
                                           kMaxRobots,
                                           of(Sender::kCoordinator),
                                           of(Sender::kVision),
                                           9999,
                                           of(Sender::kSimulator),
                                           of(Sender::kRobots),
                                           of(Sender::kOperator),
                                           of(Sender::kReferee),
                                           4294967295,
                                           of(Sender::kScenario),
                                           client_id("forklift"),
                                           of(Sender::kCoordinator, kMaxCoordinators),
                                           999999,
                                           of(Sender::kCoordinator, kMaxCoordinators - 1)};
  std::vector<Identity> identities{{Role::kVision},
                                   {Role::kSimulator},
                                   {Role::kReferee},
                                   {Role::kOperator},
                                   {Role::kViewer},
                                   {Role::kJudge},
                                   {Role::kClient, 0, 0, "forklift"},
                                   {Role::kRobot, 0, kMaxRobots - 1}};
  for (std::uint32_t i = 0; i < kMaxCoordinators; ++i) identities.push_back({Role::kCoordinator, i, i});
  for (const std::uint32_t robot : {0U, kMaxRobots - 1}) identities.push_back({Role::kAgent, robot, robot});
  int admitted = 0;
  for_each_topic([&]<typename Message>(const Topic<Message>& topic) {
    for (const std::uint32_t sender : senders) {
      CAPTURE(topic.name, sender);
      const std::uint32_t robot = sender < kMaxRobots ? sender : 0;
      const bool may = std::ranges::any_of(identities, [&](const Identity& identity) {
        return may_write(identity, topic, robot) && may_use_sender(identity, sender);
      });
      SimNetwork net(1, kBegin, {});
      SimBus from(net), to(net);
      int received = 0;
      to.subscribe(topic, robot, [&](const Message&) { ++received; });
      auto writer = from.advertise(topic, robot);
      net.run_until(net.now() + std::chrono::seconds(1));
      Message message;
      message.header().sender(sender);
      writer.publish(message, net.now());
      net.run_until(net.now() + std::chrono::seconds(1));
      CHECK(received == (may ? 1 : 0));
      CHECK(drops_of(to).total(DropReason::kForgedSender) == (may ? 0 : 1));
      admitted += may;
    }
  });
  CHECK(admitted > 30);
}

TEST_CASE("a killed process receives nothing, but its earlier messages still arrive") {
  SimNetwork net(9, kBegin, delays(0.1, 0.1));
  SimBus witness(net);
  int received = 0, fired = 0, delivered = 0;
  witness.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState&) { ++received; }));
  {
    SimBus victim(net);
    victim.at(kBegin + std::chrono::seconds(1), [&] { ++fired; });
    victim.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState&) { ++delivered; }));
    auto writer = victim.advertise(topics::kCoordinator);
    auto state = numbered(1);
    writer.publish(state, victim.now());
  }
  net.run_until(kBegin + std::chrono::seconds(2));
  CHECK(received == 1);
  CHECK(fired == 0);
  CHECK(delivered == 0);
}

TEST_CASE("readers of the same message share its attachment, and readers of different messages do not") {
  SimNetwork net(10, kBegin, {});
  SimBus sender(net), first(net), second(net);
  int decoded = 0;
  std::vector<int> values;
  const auto read = [&](SimBus& bus) {
    bus.subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& state) {
      MessageAttachment* attachment = bus.attachment(&state);
      REQUIRE(attachment != nullptr);
      CHECK(attachment->get<double>() == nullptr);
      if (!attachment->get<int>()) attachment->set(std::make_shared<int>(++decoded));
      values.push_back(*attachment->get<int>());
    });
  };
  read(first);
  read(second);
  auto writer = sender.advertise(topics::kCoordinator);
  for (std::uint64_t n = 1; n <= 2; ++n) {
    auto state = numbered(n);
    writer.publish(state, sender.now());
    net.run_until(net.now() + std::chrono::seconds(1));
  }
  CHECK(values == std::vector<int>{1, 1, 2, 2});
  const auto state = numbered(3);
  CHECK(first.attachment(&state) == nullptr);
}

}  // namespace sidestep::bus_test
