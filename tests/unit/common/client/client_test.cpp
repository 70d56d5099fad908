// SPDX-License-Identifier: Apache-2.0
#include "common/client/client.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>

#include "common/messaging/dds/bus.hpp"
#include "common/messaging/order_codec.hpp"
#include "common/version/version.hpp"
#include "tests/catch.hpp"
#include "tests/test_domain.hpp"

namespace sidestep::client::client_test {

using std::chrono::seconds;

constexpr seconds kTimeout{20};

Settings settings_for(const TestDomain& domain) {
  Settings settings;
  settings.name = "test";
  settings.domain = domain.number();
  return settings;
}

/// Answers every order from its own thread. Reports that robot 5 arrives as soon as it is ordered to drive.
/// Robots with ids above 7 are unknown.
class FakeCoordinator {
 public:
  explicit FakeCoordinator(const TestDomain& domain)
      : bus_(domain.settings("coordinator")),
        answers_(bus_.advertise(topics::kOrderAnswer)),
        statuses_(bus_.advertise(topics::kOrderStatus)),
        memory_(bus_.advertise(topics::kOrderMemory)) {
    bus_.subscribe(topics::kOrder, [this](const msg::Order& message) { on_order(message); });
    report();
    thread_ = std::thread([this] { bus_.run(); });
  }
  ~FakeCoordinator() {
    bus_.stop();
    thread_.join();
  }
  FakeCoordinator(const FakeCoordinator&) = delete;
  FakeCoordinator& operator=(const FakeCoordinator&) = delete;

  std::uint32_t last_sender() const { return last_sender_; }
  /// From now on, tells that it remembers no order.
  void tell_empty_memory() { tells_memory_ = true; }

 private:
  void on_order(const msg::Order& message) {
    const auto order = decode(message, bus_.now());
    if (!order) return;
    last_sender_ = order->client;
    const bool is_known = order->robot < 8 || order->robot == kAllRobots;
    msg::OrderAnswer answer;
    answer.client(order->client);
    answer.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
    answer.order_number(order->number);
    answer.newest_number(order->number);
    answer.result(is_known ? msg::OrderResult::RESULT_REMEMBERED : msg::OrderResult::RESULT_UNKNOWN_ROBOT);
    answers_.publish(answer, bus_.now());
    if (order->robot != 5) return;
    status_.client(order->client);
    status_.order_number(order->number);
    status_.order_state(msg::OrderState::ORDER_ARRIVED);
  }

  void report() {
    bus_.at(bus_.now() + std::chrono::milliseconds(50), [this] { report(); });
    status_.robot(5);
    status_.header().sender(5);
    statuses_.publish(status_, bus_.now());
    if (!tells_memory_) return;
    msg::OrderMemory memory = encode({}, true, false).front();
    memory.process(static_cast<std::uint32_t>(Sender::kCoordinator));
    memory.header().sender(memory.process());
    memory_.publish(memory, bus_.now());
  }

  DdsBus bus_;
  Writer<msg::OrderAnswer> answers_;
  Writer<msg::OrderStatus> statuses_;
  Writer<msg::OrderMemory> memory_;
  msg::OrderStatus status_;
  std::atomic<std::uint32_t> last_sender_{0};
  std::atomic<bool> tells_memory_{false};
  std::thread thread_;
};

TEST_CASE("the library has the version of the programs") { CHECK(std::string(version()) == kVersion); }

TEST_CASE("every refusal has its own words") {
  CHECK(std::string(text(Refusal::kNone)).empty());
  CHECK(std::string(text(Refusal::kOutsideField)) == "a goal is outside the field");
  std::set<std::string> texts;
  for (const Refusal refusal : {Refusal::kMalformed, Refusal::kUnknownRobot, Refusal::kOutsideField,
                                Refusal::kTooMany, Refusal::kUnknownZone}) {
    CHECK_FALSE(std::string(text(refusal)).empty());
    texts.insert(text(refusal));
  }
  CHECK(texts.size() == 5);
}

TEST_CASE("a client repeats an order until a coordinator answers") {
  const TestDomain domain;
  Client client(settings_for(domain));
  const OrderId hold = client.hold_all(), unknown = client.cancel(8);
  CHECK(client.wait(hold, std::chrono::milliseconds(300)) == OrderState{});
  const FakeCoordinator coordinator(domain);
  CHECK(client.wait(hold, kTimeout) == OrderState{OrderPhase::kAccepted, Refusal::kNone, 0, true});
  CHECK(client.wait(unknown, kTimeout) == OrderState{OrderPhase::kRefused, Refusal::kUnknownRobot, 0, true});
  CHECK(client.state(hold)->phase == OrderPhase::kAccepted);
  CHECK_FALSE(client.state(hold + 100).has_value());
  CHECK(coordinator.last_sender() == client_id("test"));
}

TEST_CASE("an operator's orders carry the operator's sender id") {
  const TestDomain domain;
  const FakeCoordinator coordinator(domain);
  Settings settings = settings_for(domain);
  settings.name.clear();
  settings.is_operator = true;
  Client client(settings);
  CHECK(client.wait(client.resume_all(), kTimeout)->phase == OrderPhase::kAccepted);
  CHECK(coordinator.last_sender() == static_cast<std::uint32_t>(Sender::kOperator));
}

TEST_CASE("a zone is set once a coordinator accepts the order, and setting the zone again replaces it") {
  const TestDomain domain;
  const FakeCoordinator coordinator(domain);
  Client client(settings_for(domain));
  const OrderId first = client.set_zone(1, {{{0, 0}}, 0.3});
  CHECK(client.wait(first, kTimeout)->phase == OrderPhase::kAccepted);
  const OrderId second = client.set_zone(1, {{{0, 0}, {1, 0}}, 0.3, 0.5});
  const OrderId other = client.set_zone(2, {{{0, 0}, {1, 0}, {0, 1}}});
  CHECK(client.wait(second, kTimeout)->phase == OrderPhase::kAccepted);
  CHECK(client.wait(other, kTimeout)->phase == OrderPhase::kAccepted);
  CHECK(client.state(first)->phase == OrderPhase::kReplaced);
  CHECK(client.wait(client.remove_zone(1), kTimeout)->phase == OrderPhase::kAccepted);
  CHECK(client.state(second)->phase == OrderPhase::kReplaced);
  CHECK(client.state(other)->phase == OrderPhase::kAccepted);
}

TEST_CASE("the removal of an unknown zone is refused once a coordinator has told what it remembers") {
  const TestDomain domain;
  FakeCoordinator coordinator(domain);
  Client client(settings_for(domain));
  CHECK(client.wait(client.remove_zone(1), kTimeout)->phase == OrderPhase::kAccepted);
  coordinator.tell_empty_memory();
  OrderState removal;
  const auto deadline = std::chrono::steady_clock::now() + kTimeout;
  while (removal.phase != OrderPhase::kRefused && std::chrono::steady_clock::now() < deadline)
    removal = client.wait(client.remove_zone(1), kTimeout).value();
  CHECK(removal == OrderState{OrderPhase::kRefused, Refusal::kUnknownZone, 0, true});
  const OrderId zone = client.set_zone(1, {{{0, 0}}, 0.3});
  CHECK(client.wait(client.remove_zone(1), kTimeout)->phase == OrderPhase::kAccepted);
  CHECK(client.state(zone)->phase == OrderPhase::kReplaced);
}

TEST_CASE("a callback may give orders, and wait() returns immediately in a callback") {
  const TestDomain domain;
  const FakeCoordinator coordinator(domain);
  Client client(settings_for(domain));
  std::promise<std::pair<OrderId, OrderPhase>> next;
  client.on_change([&](OrderId, const OrderState& state) {
    if (state.phase != OrderPhase::kArrived) return;
    const OrderId hold = client.hold_all();
    next.set_value({hold, client.wait(hold, kTimeout)->phase});
  });
  CHECK(client.wait(client.go(5, {{1, 2}}), kTimeout)->phase == OrderPhase::kArrived);
  auto given = next.get_future();
  REQUIRE(given.wait_for(kTimeout) == std::future_status::ready);
  const auto [hold, phase] = given.get();
  CHECK(phase == OrderPhase::kSent);
  CHECK(client.wait(hold, kTimeout)->phase == OrderPhase::kAccepted);
  client.on_change(nullptr);
}

TEST_CASE("several threads can use one client at the same time") {
  const TestDomain domain;
  const FakeCoordinator coordinator(domain);
  Client client(settings_for(domain));
  std::atomic<int> accepted{0};
  std::vector<std::thread> threads;
  for (RobotId robot = 0; robot < 4; ++robot) {
    threads.emplace_back([&, robot] {
      for (int k = 0; k < 10; ++k) {
        const auto state = client.wait(client.hold(robot), kTimeout);
        accepted += state && state->phase == OrderPhase::kAccepted;
        (void)client.robots();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(accepted == 40);
}

TEST_CASE("a client lists the robots that it has heard of with their current tasks") {
  const TestDomain domain;
  const FakeCoordinator coordinator(domain);
  Client client(settings_for(domain));
  CHECK(client.robots().empty());
  CHECK(client.wait(client.go(5, {{1, 2}}), kTimeout)->phase == OrderPhase::kArrived);
  REQUIRE(client.robots().size() == 1);
  CHECK(client.robots()[0].id == 5);
  CHECK(client.robots()[0].task == TaskState::kArrived);
  CHECK(client.robots()[0].has_own_order);
}

TEST_CASE("a client rejects invalid orders without asking a coordinator") {
  const TestDomain domain;
  Client client(settings_for(domain));
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal_of = [&](const std::vector<Goal>& goals) {
    return client.wait(client.go(3, goals), kTimeout)->refusal;
  };
  CHECK(refusal_of({}) == Refusal::kMalformed);
  CHECK(refusal_of(std::vector<Goal>(65)) == Refusal::kMalformed);
  CHECK(refusal_of({{kNan, 0}}) == Refusal::kMalformed);
  CHECK(refusal_of({{0, 1e9}}) == Refusal::kMalformed);
  CHECK(refusal_of({{0, 0, kNan}}) == Refusal::kMalformed);
  CHECK(refusal_of({{0, 0, {}, -1.0}}) == Refusal::kMalformed);
  CHECK(refusal_of({{0, 0, {}, 0.0}}) == Refusal::kMalformed);
  CHECK(refusal_of({{0, 0, {}, {}, kNan}}) == Refusal::kMalformed);
  const auto zone_refusal_of = [&](const Zone& zone) {
    return client.wait(client.set_zone(1, zone), kTimeout)->refusal;
  };
  CHECK(zone_refusal_of({}) == Refusal::kMalformed);
  CHECK(zone_refusal_of({std::vector<Point>(17)}) == Refusal::kMalformed);
  CHECK(zone_refusal_of({{{kNan, 0}}, 0.3}) == Refusal::kMalformed);
  CHECK(zone_refusal_of({{{0, 0}}, kNan}) == Refusal::kMalformed);
  CHECK(zone_refusal_of({{{0, 0}}, -1}) == Refusal::kMalformed);
  CHECK(zone_refusal_of({{{0, 0}}, 0.3, 0.0}) == Refusal::kMalformed);
  // In messages, the robot id kAllRobots means all robots.
  CHECK(client.wait(client.resume(kAllRobots), kTimeout)->refusal == Refusal::kUnknownRobot);
  CHECK(client.wait(client.go(kAllRobots, {{0, 0}}), kTimeout)->refusal == Refusal::kUnknownRobot);
}

TEST_CASE("an error about invalid client settings names the setting") {
  Settings settings;
  CHECK_THROWS_WITH(Client(settings), ContainsSubstring("name"));
  settings.name = "test";
  settings.domain = 233;
  CHECK_THROWS_WITH(Client(settings), ContainsSubstring("domain"));
  settings.domain = 0;
  settings.interface = "1.2.3.4";
  CHECK_THROWS_WITH(Client(settings), ContainsSubstring("interface"));
}

}  // namespace sidestep::client::client_test
