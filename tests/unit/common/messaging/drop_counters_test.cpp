// SPDX-License-Identifier: Apache-2.0
#include "common/protocol/drop_counters.hpp"

#include <set>
#include <string>

#include "common/messaging/counter_publisher.hpp"
#include "common/messaging/drop_codec.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::drop_counters_test {

TEST_CASE("drops are counted by reason and robot") {
  DropCounters drops;
  CHECK(drops.total() == 0);
  drops.count(DropReason::kLateVersion, 3);
  drops.count(DropReason::kLateVersion, 3, 4);
  drops.count(DropReason::kLateVersion, 7);
  drops.count(DropReason::kLateVersion);
  drops.count(DropReason::kOtherRules, std::nullopt, 10);
  drops.count(DropReason::kWrongBase, 3, 0);
  CHECK(drops.total(DropReason::kLateVersion) == 7);
  CHECK(drops.total() == 17);
  std::multiset<std::uint64_t> counts;
  for (const DropCount& one : drops.counts()) {
    if (one.count > 0) counts.insert(one.count);
  }
  CHECK(counts == std::multiset<std::uint64_t>{1, 1, 5, 10});
  DropCounters sum = drops;
  sum.add(drops);
  CHECK(sum.total(DropReason::kLateVersion) == 14);
  CHECK(sum.counts().size() == drops.counts().size());
}

TEST_CASE("the memory of drop counters does not grow with the number of robots, and no count is lost") {
  DropCounters drops;
  for (RobotId robot = 0; robot < 100'000; ++robot) drops.count(DropReason::kMalformedCommand, robot);
  CHECK(drops.counts().size() == DropCounters::kCapacity);
  CHECK(drops.total(DropReason::kMalformedCommand) == 100'000);
  drops.count(DropReason::kFencedCommand, 5);
  CHECK(drops.total(DropReason::kFencedCommand) == 1);
}

TEST_CASE("every drop reason has its own lower-case name and a description") {
  std::set<std::string> names;
  for (const DropReasonInfo& info : kDropReasons) {
    const std::string name = info.name;
    CAPTURE(name);
    CHECK(names.insert(name).second);
    CHECK(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") == std::string::npos);
    CHECK(std::string(info.description).size() > 3);
  }
}

TEST_CASE("counters above zero survive encoding and decoding") {
  const std::uint64_t seed = GENERATE(1u, 2u, 3u);
  CAPTURE(seed);
  Rng rng(seed);
  DropCounters drops;
  for (int i = 0; i < 500; ++i) {
    const auto reason = static_cast<DropReason>(rng.below(kDropReasonCount));
    drops.count(reason, rng.chance(0.5) ? std::optional<RobotId>(rng.below(kMaxRobots)) : std::nullopt,
                rng.below(3));
  }
  msg::Counters message;
  message.process(20000);
  message.header().sender(20000);
  encode(drops, message);
  const auto decoded = decode(message);
  REQUIRE(decoded);
  DropCounters again;
  for (const DropCount& one : *decoded) {
    CHECK(one.count > 0);
    again.count(one.reason, one.robot, one.count);
  }
  for (const DropReasonInfo& info : kDropReasons) CHECK(again.total(info.reason) == drops.total(info.reason));
}

TEST_CASE("invalid counters are refused") {
  msg::Counters valid;
  valid.process(7);
  valid.header().sender(7);
  valid.counts().emplace_back().robot(msg::NO_ROBOT);
  REQUIRE(decode(valid));
  const auto is_refused = [&](auto spoil) {
    msg::Counters hostile = valid;
    spoil(hostile);
    return !decode(hostile);
  };
  CHECK(is_refused([](msg::Counters& m) { m.header().sender(8); }));
  CHECK(is_refused([](msg::Counters& m) { m.process(8); }));
  CHECK(is_refused([](msg::Counters& m) { m.counts()[0].reason(kDropReasonCount); }));
  CHECK(is_refused([](msg::Counters& m) { m.counts()[0].reason(65535); }));
  CHECK(is_refused([](msg::Counters& m) { m.counts()[0].robot(kMaxRobots); }));
  CHECK(is_refused([](msg::Counters& m) { m.counts().resize(msg::MAX_COUNTERS + 1, m.counts()[0]); }));
}

TEST_CASE("a process publishes its own counters and the counters of its bus once per second") {
  SimNetwork network{1, time_from_ns(1'000'000'000'000), {}};
  SimBus bus(network), outside(network);
  std::vector<msg::Counters> received;
  outside.subscribe(topics::kCounters, [&](const msg::Counters& m) { received.push_back(m); });
  CounterPublisher publisher(bus, 20000, 9,
                             [](DropCounters& drops) { drops.count(DropReason::kUntimelyFrame, 3, 2); });
  bus.count_drop(DropReason::kMalformedRules);
  network.run_until(network.now() + std::chrono::milliseconds(3500));
  REQUIRE(received.size() == 3);
  CHECK(received[0].process() == 20000);
  CHECK(received[0].header().incarnation() == 9);
  const auto counts = decode(received[2]);
  REQUIRE(counts);
  REQUIRE(counts->size() == 2);
  CHECK((*counts)[0].reason == DropReason::kMalformedRules);
  CHECK((*counts)[1].robot == 3);
  CHECK((*counts)[1].count == 2);
}

TEST_CASE("the simulated network counts lost messages and messages that overflow a paused process's queue") {
  NetworkSpec spec;
  spec.loss = 0.5;
  SimNetwork network{1, time_from_ns(1'000'000'000'000), spec};
  SimBus from(network), to(network);
  std::uint64_t received = 0;
  to.subscribe(topics::kCounters, [&](const msg::Counters&) { ++received; });
  auto writer = from.advertise(topics::kCounters);
  msg::Counters message;
  for (int i = 0; i < 1000; ++i) writer.publish(message, from.now());
  network.run_until(network.now() + std::chrono::seconds(1));
  CHECK(received > 400);
  CHECK(drops_of(to).total(DropReason::kInjectedLoss) == 1000 - received);
  CHECK(drops_of(from).total() == 0);
  to.pause(network.now() + std::chrono::seconds(1), 10);
  received = 0;
  const std::uint64_t lost_before = drops_of(to).total(DropReason::kInjectedLoss);
  for (int i = 0; i < 1000; ++i) writer.publish(message, from.now());
  network.run_until(network.now() + std::chrono::seconds(2));
  CHECK(received == 10);
  const std::uint64_t lost = drops_of(to).total(DropReason::kInjectedLoss) - lost_before;
  CHECK(drops_of(to).total(DropReason::kQueueFull) == 1000 - lost - 10);
}

}  // namespace sidestep::drop_counters_test
