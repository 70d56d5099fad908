// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/bus.hpp"

#include <memory>
#include <optional>
#include <set>
#include <thread>

#include "common/messaging/topics.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"
#include "tests/unit/common/messaging/dds/test_support.hpp"

namespace sidestep::bus_test {

/// Publishes a random message until it arrives on the other bus, and requires that it arrives unchanged.
template <typename Message>
void check_round_trip(const Topic<Message>& topic, DdsBus& from, DdsBus& to, std::uint64_t seed) {
  INFO("topic " << topic.name << " seed " << seed);
  Rng rng(seed);
  Message sent = random_message<Message>(rng, topic.type.max_elements > 0, 7);
  for (const Sender sender : {Sender::kVision, Sender::kCoordinator, Sender::kSimulator, Sender{3}}) {
    if (topic.writers.overlaps(roles_of(static_cast<std::uint32_t>(sender))))
      sent.header().sender(static_cast<std::uint32_t>(sender));
  }
  CHECK_FALSE(sent == Message());
  std::optional<Message> received;
  to.subscribe<Message>(topic, 3, [&](const Message& m) { received = m; });
  auto writer = from.advertise(topic, 3);
  const auto has_arrived = [&] {
    if (!received) writer.publish(sent, from.now());
    return received.has_value();
  };
  REQUIRE(run_until(has_arrived, to));
  // An earlier copy may have arrived; it differs only in number and stamp.
  received->header().message_number(sent.header().message_number());
  received->header().stamp_ns(sent.header().stamp_ns());
  CHECK(*received == sent);
}

TEST_CASE("every message type arrives over DDS unchanged") {
  DdsBus from(test_settings("from"));
  DdsBus to(test_settings("to"));
  check_round_trip(topics::kDetections, from, to, 1);
  check_round_trip(topics::kWorld, from, to, 2);
  check_round_trip(topics::kObstacles, from, to, 12);
  check_round_trip(topics::kCommand, from, to, 3);
  check_round_trip(topics::kFeedback, from, to, 4);
  check_round_trip(topics::kRegistration, from, to, 5);
  check_round_trip(topics::kProposal, from, to, 6);
  check_round_trip(topics::kVerdict, from, to, 7);
  check_round_trip(topics::kLedger, from, to, 8);
  check_round_trip(topics::kCoordinator, from, to, 9);
  check_round_trip(topics::kStatus, from, to, 10);
  check_round_trip(topics::kTruth, from, to, 11);
  check_round_trip(topics::kCounters, from, to, 13);
  check_round_trip(topics::kScan, from, to, 14);
  CHECK(drops_of(to).total(DropReason::kUnreadable) == 0);
}

TEST_CASE("a message on a robot's channel reaches only that robot") {
  DdsBus coordinator(test_settings());
  DdsBus agents(test_settings());
  std::vector<int> right(3, 0);
  int wrong = 0;
  std::vector<Writer<msg::Verdict>> writers;
  for (std::uint32_t robot = 0; robot < 3; ++robot) {
    writers.push_back(coordinator.advertise(topics::kVerdict, robot));
    agents.subscribe<msg::Verdict>(topics::kVerdict, robot, [&, robot](const msg::Verdict& m) {
      ++(m.robot() == robot ? right[robot] : wrong);
    });
  }
  const auto all_have_enough = [&] {
    for (std::uint32_t robot = 0; robot < 3; ++robot) {
      msg::Verdict verdict;
      verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
      verdict.robot(robot);
      writers[robot].publish(verdict, coordinator.now());
    }
    return right[0] >= 10 && right[1] >= 10 && right[2] >= 10;
  };
  CHECK(run_until(all_have_enough, agents));
  CHECK(wrong == 0);
}

TEST_CASE("a world state with a thousand robots arrives") {
  DdsBus vision(test_settings());
  DdsBus agent(test_settings());
  Rng rng(5);
  msg::WorldState sent = random_message<msg::WorldState>(rng, true, 1000);
  sent.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  int whole = 0;
  agent.subscribe<msg::WorldState>(topics::kWorld,
                                   [&](const msg::WorldState& m) { whole += m.robots() == sent.robots(); });
  auto writer = vision.advertise(topics::kWorld);
  const auto has_arrived = [&] {
    writer.publish(sent, vision.now());
    return whole >= 10;
  };
  CHECK(run_until(has_arrived, agent));
}

TEST_CASE("one shared topic carries the states of hundreds of robots") {
  constexpr std::uint32_t kRobots = 300;
  DdsBus agents(test_settings());
  DdsBus coordinator(test_settings());
  std::set<std::uint32_t> received;
  coordinator.subscribe<msg::Proposal>(topics::kProposal,
                                       [&](const msg::Proposal& m) { received.insert(m.robot()); });
  auto writer = agents.advertise(topics::kProposal);
  std::uint32_t next = 0;
  const auto all_are_received = [&] {
    for (int i = 0; i < 10; ++i) {
      msg::Proposal proposal;
      proposal.robot(next++ % kRobots);
      writer.publish(proposal, agents.now());
    }
    return received.size() == kRobots;
  };
  CHECK(run_until(all_are_received, coordinator));
}

TEST_CASE("a reader gets only the latest of several waiting states unless it keeps all states") {
  constexpr std::uint64_t kStates = 20;
  DdsSettings settings = test_settings("keeper");
  settings.keeps_all = true;
  DdsBus keeper(settings), actor(test_settings("actor")), vision(test_settings("vision"));
  std::vector<std::uint64_t> kept, acted_on;
  keeper.subscribe<msg::WorldState>(topics::kWorld,
                                    [&](const msg::WorldState& m) { kept.push_back(m.frames()); });
  actor.subscribe<msg::WorldState>(topics::kWorld,
                                   [&](const msg::WorldState& m) { acted_on.push_back(m.frames()); });
  auto writer = vision.advertise(topics::kWorld);
  msg::WorldState state;
  state.header().sender(static_cast<std::uint32_t>(Sender::kVision));
  const auto are_connected = [&] {
    writer.publish(state, vision.now());
    return !kept.empty() && !acted_on.empty();
  };
  REQUIRE(run_until(are_connected, keeper, actor));
  // A busy machine may run the readers' bus after each state, so that no state is replaced: try again.
  std::uint64_t frames = 0;
  bool has_replaced = false;
  const auto have_replaced = [&] {
    kept.clear();
    acted_on.clear();
    const std::uint64_t last = frames + kStates;
    while (frames < last) {
      state.frames(++frames);
      writer.publish(state, vision.now());
    }
    const auto has_last = [&](const std::vector<std::uint64_t>& got) {
      return !got.empty() && got.back() == last;
    };
    REQUIRE(run_until([&] { return has_last(kept) && has_last(acted_on); }, keeper, actor));
    std::erase_if(kept, [&](std::uint64_t frame) { return frame <= last - kStates; });
    CHECK(kept.size() == kStates);
    return acted_on.size() < kStates;
  };
  const Time deadline = vision.now() + kDeadline;
  while (!has_replaced && vision.now() < deadline) has_replaced = have_replaced();
  CHECK(has_replaced);
}

TEST_CASE("all events arrive in order") {
  constexpr std::uint64_t kEvents = 300;
  constexpr Topic<msg::Verdict> kEvent{{"test/event",
                                        Role::kCoordinator,
                                        {},
                                        Qos::kEvent,
                                        false,
                                        false,
                                        message_type<msg::Verdict>("sidestep::msg::Verdict")}};
  DdsBus from(test_settings());
  DdsBus to(test_settings());
  std::vector<std::uint64_t> numbers;
  to.subscribe<msg::Verdict>(kEvent, [&](const msg::Verdict& m) { numbers.push_back(m.proposal_number()); });
  auto writer = from.advertise(kEvent);
  msg::Verdict event;
  event.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  // Messages sent before discovery may be lost, but none after the first one that is received.
  const auto is_matched = [&] {
    writer.publish(event, from.now());
    return !numbers.empty();
  };
  REQUIRE(run_until(is_matched, to));
  std::uint64_t last = 0;
  const auto all_have_arrived = [&] {
    if (last < kEvents) {
      event.proposal_number(++last);
      writer.publish(event, from.now());
    }
    return numbers.back() == kEvents;
  };
  REQUIRE(run_until(all_have_arrived, to));
  std::uint64_t expected = 0;
  for (const std::uint64_t number : numbers) {
    if (number == 0 && expected == 0) continue;
    CHECK(number == ++expected);
  }
  CHECK(expected == kEvents);
}

TEST_CASE("stop() from another thread ends run() permanently") {
  DdsBus bus(test_settings());
  std::thread stopper([&] { bus.stop(); });
  bus.run();
  stopper.join();
  bool fired = false;
  bus.at(bus.now(), [&] { fired = true; });
  bus.run();
  CHECK_FALSE(fired);
}

TEST_CASE("a writer may outlive its bus") {
  auto bus = std::make_unique<DdsBus>(test_settings());
  auto writer = bus->advertise(topics::kVerdict, 1);
  bus.reset();
  msg::Verdict verdict;
  verdict.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
  writer.publish(verdict, EventLoop::now());
  CHECK(verdict.header().message_number() == 1);
}

TEST_CASE("invalid DDS settings are rejected with the reason") {
  DdsSettings settings = test_settings();
  settings.domain = 233;
  CHECK_THROWS_WITH(DdsBus(settings), ContainsSubstring("domain: expected 0..232, got 233"));
  settings.domain = -1;
  CHECK_THROWS_WITH(DdsBus(settings), ContainsSubstring("domain: expected 0..232, got -1"));
  settings = test_settings();
  for (const char* address : {"", "nonsense", "192.0.2.1", "127.0.0.1 "}) {
    settings.interface = address;
    CHECK_THROWS_WITH(DdsBus(settings), ContainsSubstring("an address of this machine"));
  }
}

TEST_CASE("a bus reports the loopback address that it listens on") {
  DdsBus bus(test_settings());
  bus.subscribe<msg::WorldState>(topics::kWorld, [](const msg::WorldState&) {});
  CHECK_THAT(bus.locators(), ContainsSubstring("UDPv4:[127.0.0.1]:"));
}

}  // namespace sidestep::bus_test
