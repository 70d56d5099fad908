// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/rules_exchange.hpp"

#include <algorithm>
#include <optional>

#include "common/messaging/sim/bus.hpp"
#include "common/protocol/process_names.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::rules_exchange_test {

using namespace std::chrono_literals;

Scenario with_margin(double margin_m) {
  Scenario scenario;
  scenario.margin_m = margin_m;
  return scenario;
}

/// A process that publishes coordinator states and counts those that it receives.
struct Process {
  Process(SimNetwork& network, std::uint32_t process, std::optional<double> margin_m)
      : id(process), bus(network) {
    if (margin_m) {
      exchange.emplace(bus, id, SharedRules(with_margin(*margin_m)),
                       [this](const RulesMismatch& mismatch) { mismatches.push_back(describe(mismatch)); });
    }
    writer = bus.advertise(topics::kCoordinator);
    bus.subscribe(topics::kCoordinator, [this](const msg::CoordinatorState&) { ++received; });
    bus.observe(topics::kCoordinator, 0, [this](const msg::CoordinatorState&) { ++observed; });
  }
  void publish() {
    msg::CoordinatorState state;
    state.coordinator(id);
    state.header().sender(id);
    writer.publish(state, bus.now());
  }

  std::uint32_t id;
  SimBus bus;
  std::optional<RulesExchange> exchange;
  Writer<msg::CoordinatorState> writer;
  std::vector<std::string> mismatches;
  int received = 0, observed = 0;
};

SimNetwork lossless() { return {1, time_from_ns(1'000'000'000'000), NetworkSpec{}}; }

TEST_CASE("two processes with different rules refuse each other's messages, and both name the difference") {
  SimNetwork network = lossless();
  Process a(network, 10000, 0.01), b(network, 10001, 0.02);
  for (int i = 0; i < 200; ++i) {
    a.publish();
    if (i >= 100) b.publish();
    network.run_until(network.now() + 20ms);
  }
  CHECK(a.received == 200);  // its own messages
  CHECK(b.received == 100);
  CHECK(a.observed == 300);
  CHECK(drops_of(a.bus).total(DropReason::kOtherRules) == 100);
  CHECK(drops_of(b.bus).total(DropReason::kOtherRules) == 200);
  const std::string refuses_b = "refuses coordinator 1, which has different rules",
                    refuses_a = "refuses coordinator, which has different rules";
  // b refuses a before it has received a's rules. a receives b's rules before it has refused b.
  CHECK(b.mismatches == std::vector{refuses_a, refuses_a + ": margin_m is 0.01 instead of 0.02"});
  CHECK(a.mismatches == std::vector{refuses_b + ": margin_m is 0.02 instead of 0.01"});
}

TEST_CASE("a process with rules refuses messages without rules, and a process without rules accepts all") {
  SimNetwork network = lossless();
  Process with(network, 10000, 0.01), without(network, 10001, std::nullopt);
  with.publish();
  without.publish();
  network.run_until(network.now() + 1s);
  CHECK(with.received == 1);
  CHECK(without.received == 2);
}

TEST_CASE("rules are sent at a bounded rate when many messages are refused") {
  SimNetwork network = lossless();
  Process a(network, 10000, 0.01), b(network, 10001, 0.02);
  int sent = 0;
  a.bus.subscribe(topics::kRules, [&](const msg::SharedRules&) { ++sent; });
  for (int i = 0; i < 1000; ++i) {
    b.publish();
    network.run_until(network.now() + 10ms);
  }
  CHECK(sent >= 34);  // the first ones are lost: no process has discovered their writers
  CHECK(sent <= 42);  // rules of two processes for ten seconds
  CHECK(a.mismatches.size() == 2);
}

TEST_CASE("a single refused message makes both sides name the difference") {
  // The refusing process has not sent its rules before, so no process has discovered its writer.
  SimNetwork network = lossless();
  Process a(network, 10000, 0.01), b(network, 10001, 0.02);
  network.run_until(network.now() + 1s);
  b.publish();
  network.run_until(network.now() + 3s);
  CHECK_FALSE(a.mismatches.empty());
  CHECK(b.mismatches ==
        std::vector<std::string>{
            "refuses coordinator, which has different rules: margin_m is 0.01 instead of 0.02"});
}

TEST_CASE("of thousands of made-up processes, 256 are named and then one more every ten seconds") {
  SimNetwork network = lossless();
  Process a(network, 10000, 0.01);
  a.bus.subscribe(topics::kRegistration, [](const msg::Registration&) {});
  SimBus stranger(network);
  auto writer = stranger.advertise(topics::kRegistration);
  network.run_until(network.now() + 1s);
  for (std::uint32_t i = 0; i < 5000; ++i) {
    msg::Registration registration;
    registration.header().sender(i % kMaxRobots);
    writer.publish(registration, stranger.now());
    network.run_until(network.now() + 1ms);
  }
  CHECK(drops_of(a.bus).total(DropReason::kOtherRules) == 5000);
  CHECK(a.mismatches.size() == 257);
  // A real process with different rules is also named, within twenty seconds.
  Process b(network, 10001, 0.02);
  const auto is_b = [](const std::string& text) { return text.find("coordinator 1") != std::string::npos; };
  for (int i = 0; i < 2000 && std::ranges::none_of(a.mismatches, is_b); ++i) {
    b.publish();
    network.run_until(network.now() + 10ms);
  }
  CHECK(std::ranges::any_of(a.mismatches, is_b));
  CHECK(a.mismatches.size() <= 260);
}

}  // namespace sidestep::rules_exchange_test
