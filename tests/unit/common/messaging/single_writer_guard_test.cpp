// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/single_writer_guard.hpp"

#include "common/messaging/role_watch.hpp"
#include "common/messaging/sim/bus.hpp"
#include "common/protocol/senders.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"
#include "tests/drops.hpp"

namespace sidestep::single_writer_guard_test {

using namespace std::chrono_literals;
using Outcome = SingleWriterGuard::Outcome;
const Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kCycle = 16ms;
// Incarnations of different processes.
constexpr std::uint64_t kOne = 1'000'000, kTwo = 2'000'000, kThree = 3'000'000;

TEST_CASE("all messages from a single process are used, even after pauses") {
  SingleWriterGuard sender;
  for (const Duration at : {0ms, 16ms, 500ms, 3000ms, 20000ms})
    CHECK(sender.receive(7, kBegin + at) == Outcome::kCounts);
}

TEST_CASE("messages from a second process are refused until the first has been silent for a second") {
  SingleWriterGuard sender;
  CHECK(sender.receive(kOne, kBegin) == Outcome::kCounts);
  Time now = kBegin + 100ms;
  for (; now < kBegin + SingleWriterGuard::kGoneAfter; now += kCycle)
    CHECK(sender.receive(kTwo, now) == Outcome::kRefused);
  for (int i = 0; i < 100; ++i) CHECK(sender.receive(kTwo, now += kCycle) == Outcome::kCounts);
}

TEST_CASE("a single message from another process has no effect") {
  SingleWriterGuard sender;
  for (int i = 0; i < 100; ++i) {
    const Time now = kBegin + kCycle * i;
    CHECK(sender.receive(kOne, now) == Outcome::kCounts);
    if (i == 50) CHECK(sender.receive(kTwo, now) == Outcome::kRefused);
  }
}

TEST_CASE("messages from two competing processes are ignored until one of them is gone") {
  const std::uint64_t first = GENERATE(kOne, kThree);
  SingleWriterGuard sender;
  Time now = kBegin;
  CHECK(sender.receive(first, now) == Outcome::kCounts);
  int counted = 0, reported = 0;
  const auto receive = [&](std::uint64_t incarnation) {
    const Outcome outcome = sender.receive(incarnation, now);
    CHECK((outcome != Outcome::kCounts || incarnation == first));
    counted += outcome == Outcome::kCounts;
    reported += outcome == Outcome::kNewConflict;
  };
  for (int i = 0; i < 600; ++i) {
    now += kCycle;
    receive(kTwo);
    receive(first);
  }
  CHECK(counted == 1);
  CHECK(reported == 1);
  SECTION("the later process is gone") {
    const Time gone_at = now;
    while (now < gone_at + SingleWriterGuard::kGoneAfter - kCycle)
      CHECK(sender.receive(first, now += kCycle) == Outcome::kRefused);
    now += kCycle;
    CHECK(sender.receive(first, now += kCycle) == Outcome::kCounts);
  }
  SECTION("the earlier process is gone") {
    const Time gone_at = now;
    while (now < gone_at + SingleWriterGuard::kConflictSilenceTimeout - kCycle)
      CHECK(sender.receive(kTwo, now += kCycle) == Outcome::kRefused);
    now += kCycle;
    CHECK(sender.receive(kTwo, now += kCycle) == Outcome::kCounts);
  }
}

TEST_CASE("a process that has just started trusts no sender until it has listened for a while") {
  SingleWriterGuard sender(SingleWriterGuard::kListening);
  Time now = kBegin;
  for (; now < kBegin + SingleWriterGuard::kListening; now += kCycle)
    CHECK(sender.receive(1, now) == Outcome::kRefused);
  for (int i = 0; i < 100; ++i) CHECK(sender.receive(1, now += kCycle) == Outcome::kCounts);
}

TEST_CASE("a process that starts while two others send trusts neither in any order of messages") {
  const auto seed = GENERATE(range(1u, 101u));
  CAPTURE(seed);
  Rng rng(seed);
  SingleWriterGuard sender(SingleWriterGuard::kListening);
  int reported = 0;
  for (int cycle = 0; cycle < 600; ++cycle) {
    for (const std::uint64_t incarnation : {1u, 2u}) {
      // The messages arrive in any order, some are lost.
      if (rng.chance(0.3)) continue;
      const Time now = kBegin + kCycle * cycle + from_seconds(rng.uniform(0, 0.001));
      const Outcome outcome = sender.receive(incarnation, now);
      CHECK(outcome != Outcome::kCounts);
      reported += outcome == Outcome::kNewConflict;
    }
  }
  CHECK(reported == 1);
}

TEST_CASE("a receiver whose clock was set back still trusts and follows senders") {
  const Duration listening = GENERATE(Duration{0}, SingleWriterGuard::kListening);
  CAPTURE(to_seconds(listening));
  const Duration ahead = 436s;
  {
    SingleWriterGuard sender(listening);
    (void)sender.receive(kOne, kBegin + ahead);
    Time now = kBegin;
    for (; now < kBegin + listening; now += kCycle) (void)sender.receive(kOne, now);
    CHECK(sender.receive(kOne, now + kCycle) == Outcome::kCounts);
    // The process ends, and another process takes its place.
    now += SingleWriterGuard::kGoneAfter + kCycle;
    (void)sender.receive(kTwo, now);
    CHECK(sender.receive(kTwo, now + listening + kCycle) == Outcome::kCounts);
  }
  {
    SingleWriterGuard sender;
    for (int i = 0; i < 10; ++i)
      for (const std::uint64_t process : {kOne, kTwo}) (void)sender.receive(process, kBegin + ahead);
    CHECK(sender.receive(kOne, kBegin) != Outcome::kCounts);
    CHECK(sender.receive(kOne, kBegin + SingleWriterGuard::kGoneAfter + kCycle) == Outcome::kCounts);
  }
}

TEST_CASE("messages from three or more competing processes are ignored") {
  const auto seed = GENERATE(range(1u, 51u));
  CAPTURE(seed);
  Rng rng(seed);
  SingleWriterGuard sender;
  (void)sender.receive(kOne, kBegin);
  for (int i = 0; i < 1000; ++i) {
    const std::uint64_t incarnation = kOne * (1 + rng.below(5));
    const bool counts = sender.receive(incarnation, kBegin + 4ms * i) == Outcome::kCounts;
    CHECK((!counts || (incarnation == kOne && i < 100)));
  }
}

TEST_CASE("a robot that raises its incarnation is heard immediately, and its older messages are refused") {
  SingleWriterGuard sender;
  Time now = kBegin;
  for (std::uint64_t incarnation = 0; incarnation < 5; ++incarnation) {
    for (int i = 0; i < 10; ++i) CHECK(sender.receive(kOne + incarnation, now += kCycle) == Outcome::kCounts);
    CHECK(sender.receive(kOne + incarnation + 1, now += 1ms) == Outcome::kCounts);
    CHECK(sender.receive(kOne + incarnation, now += 1ms) == Outcome::kRefused);
    now += SingleWriterGuard::kGoneAfter;
  }
  // A process that began much later or earlier is another process.
  CHECK(sender.receive(kOne + 5, now) == Outcome::kCounts);
  CHECK(sender.receive(kOne + 5 + SingleWriterGuard::kMaxRaise + 1, now) == Outcome::kRefused);
  CHECK(sender.receive(kOne - 1, now) != Outcome::kCounts);
}

TEST_CASE(
    "messages from two writers of a single-writer topic are ignored, and the conflict is reported once") {
  SimNetwork network(1, kBegin, {});
  SimBus first(network), second(network), reader(network);
  auto one = first.advertise(topics::kFeedback, 3), two = second.advertise(topics::kFeedback, 3);
  int received = 0, contests = 0;
  reader.subscribe(topics::kFeedback, 3, [&](const msg::Feedback&) { ++received; });
  reader.watch_conflicts([&](const TopicInfo& topic, std::uint32_t robot, const msg::Header& header) {
    ++contests;
    CHECK(describe_conflict(topic, robot, header) ==
          "two processes send 'feedback/3' as robot 3; their messages on this topic are ignored "
          "until one of them exits");
  });
  msg::Feedback feedback;
  const auto send = [&](auto& writer, Incarnation incarnation) {
    feedback.header().incarnation(incarnation);
    writer.publish(feedback, network.now());
    network.run_until(network.now() + 5ms);
  };
  for (int i = 0; i < 50; ++i) send(one, kOne);
  CHECK(received == 50);
  for (int i = 0; i < 50; ++i) {
    send(two, kTwo);
    send(one, kOne);
  }
  CHECK(received <= 52);
  CHECK(contests == 1);
  CHECK(drops_of(reader).total(DropReason::kContestedSender) >= 98);
}

/// A process that counts messages and detects others with its id.
struct Part {
  SimBus bus;
  std::vector<Incarnation> others;
  RoleWatch role;
  Writer<msg::Counters> writer = bus.advertise(topics::kCounters);
  std::uint32_t process;
  Incarnation incarnation;

  Part(SimNetwork& network, std::uint32_t id, Incarnation own)
      : bus(network),
        role(bus, id, own, [this](Incarnation other) { others.push_back(other); }),
        process(id),
        incarnation(own) {}
  void count() {
    msg::Counters message;
    message.process(process);
    message.header().sender(process);
    message.header().incarnation(incarnation);
    writer.publish(message, bus.now());
  }
};

TEST_CASE("processes that wrongly share an id detect each other once, but not from a single message") {
  const auto id = static_cast<std::uint32_t>(
      GENERATE(Sender::kSimulator, Sender::kVision, Sender::kReferee, Sender::kCoordinator));
  SimNetwork network(1, kBegin, {});
  Part first(network, id, 100), second(network, id, 200);
  Part other(network, static_cast<std::uint32_t>(Sender::kCoordinator) + 1, 300);
  for (int i = 0; i < 5; ++i) {
    for (Part* part : {&first, &second, &other}) part->count();
    network.run_until(network.now() + 10ms);
    if (i == 0) {
      network.run_until(network.now() + 900ms);
      CHECK(first.others.empty());
      CHECK(second.others.empty());
    }
    network.run_until(network.now() + 1s);
  }
  CHECK(first.others == std::vector<Incarnation>{200});
  CHECK(second.others == std::vector<Incarnation>{100});
  CHECK(other.others.empty());
}

TEST_CASE("another process with the same id is detected even after many messages from made-up ones") {
  SimNetwork network(1, kBegin, {});
  const auto id = static_cast<std::uint32_t>(Sender::kVision);
  Part first(network, id, 100), second(network, id, 200), inventor(network, id, 0);
  for (Incarnation i = 1000; i < 2000; ++i) {
    inventor.incarnation = i;
    inventor.count();
    network.run_until(network.now() + 1ms);
  }
  network.run_until(network.now() + 1s);
  for (int i = 0; i < 3; ++i) {
    second.count();
    network.run_until(network.now() + 1s);
  }
  CHECK(first.others == std::vector<Incarnation>{200});
}

TEST_CASE("several processes may use the same agent's id") {
  SimNetwork network(1, kBegin, {});
  Part first(network, 3, 100), second(network, 3, 200);
  for (int i = 0; i < 5; ++i) {
    first.count();
    second.count();
    network.run_until(network.now() + 1s);
  }
  CHECK(first.others.empty());
  CHECK_FALSE(must_be_alone(3));
}

}  // namespace sidestep::single_writer_guard_test
