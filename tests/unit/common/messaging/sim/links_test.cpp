// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/sim/links.hpp"

#include <algorithm>
#include <utility>

#include "common/messaging/sim/bus.hpp"
#include "tests/catch.hpp"

namespace sidestep::links_test {

using namespace std::chrono_literals;
const Time kBegin = time_from_ns(1'000'000'000);

/// Three processes. The first process sends numbered messages to the others, a millisecond apart.
struct Rig {
  SimNetwork network{1, kBegin, {}};
  ProcessId ids[3] = {network.new_process(), network.new_process(), network.new_process()};
  SimBus sender{network, {ids[0]}}, near{network, {ids[1]}}, far{network, {ids[2]}};
  Writer<msg::CoordinatorState> writer = sender.advertise(topics::kCoordinator);
  std::vector<std::uint64_t> near_received, far_received;
  std::vector<double> far_delays_s;

  Rig() {
    near.subscribe(topics::kCoordinator, std::function([this](const msg::CoordinatorState& s) {
                     near_received.push_back(s.epoch());
                   }));
    far.subscribe(topics::kCoordinator, std::function([this](const msg::CoordinatorState& s) {
                    far_received.push_back(s.epoch());
                    far_delays_s.push_back(to_seconds(network.now() - time_from_ns(s.header().stamp_ns())));
                  }));
  }
  void send(std::uint64_t count) {
    const Time from = network.now();
    for (std::uint64_t n = 1; n <= count; ++n) {
      sender.at(from + Duration{1ms} * n, [this, n] {
        msg::CoordinatorState state;
        state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
        state.epoch(n);
        writer.publish(state, sender.now());
      });
    }
    network.run_until(from + Duration{1ms} * count + 2s);
  }
};

TEST_CASE("a link has the specified loss and mean burst length") {
  struct Specified {
    double loss, mean_burst;
  };
  const auto [loss, mean_burst] = GENERATE(Specified{0.3, 1}, Specified{0.3, 10}, Specified{0.05, 25});
  CAPTURE(loss, mean_burst);
  SimLinks links;
  LinkQuality quality;
  quality.loss = loss;
  quality.mean_burst = mean_burst;
  links.set(0, 1, quality, kBegin);
  Rng rng(7);
  constexpr int kMessages = 400'000;
  int lost = 0, bursts = 0;
  bool was_lost = false;
  for (int i = 0; i < kMessages; ++i) {
    const bool is_lost = links.send(0, 1, rng).count == 0;
    lost += is_lost;
    bursts += is_lost && !was_lost;
    was_lost = is_lost;
  }
  CHECK(lost == Approx(kMessages * loss).epsilon(0.05));
  CHECK(static_cast<double>(lost) / bursts == Approx(mean_burst).epsilon(0.05));
}

TEST_CASE("link delays are right-skewed, within their bounds and have about the specified mean") {
  SimLinks links;
  LinkQuality quality{0, 1, 0.5, 1ms, 11ms, 150ms, false};
  links.set(2, 0, quality, kBegin);
  Rng rng(3);
  double total_s = 0;
  int above_mean = 0, count = 0, messages = 100'000;
  for (int i = 0; i < messages; ++i) {
    const MessageCopies copies = links.send(2, 0, rng);
    for (std::size_t c = 0; c < copies.count; ++c) {
      CHECK(copies.delays[c] >= Duration{1ms});
      CHECK(copies.delays[c] <= Duration{150ms});
      total_s += to_seconds(copies.delays[c]);
      above_mean += copies.delays[c] > Duration{11ms};
      ++count;
    }
  }
  CHECK(count == Approx(1.5 * messages).epsilon(0.02));
  CHECK(total_s / count == Approx(0.011).epsilon(0.03));
  // The fraction of an exponential distribution above its mean is 1/e.
  CHECK(static_cast<double>(above_mean) / count == Approx(0.368).epsilon(0.05));
}

TEST_CASE("a cut blocks one direction of one link until it is ended") {
  Rig rig;
  LinkQuality cut;
  cut.is_cut = true;
  rig.network.set_link(rig.ids[0], rig.ids[2], cut);
  rig.network.set_link(rig.ids[2], rig.ids[0], {});
  rig.send(50);
  CHECK(rig.near_received.size() == 50);
  CHECK(rig.far_received.empty());
  rig.network.set_link(rig.ids[0], rig.ids[2], {});
  rig.send(50);
  CHECK(rig.far_received.size() == 50);
}

TEST_CASE("links can be set in any order and keep their qualities as links are added") {
  SimLinks links;
  CHECK_FALSE(links.any());
  LinkQuality slow;
  slow.delay_min = 5ms;
  links.set(1, 0, slow, kBegin);
  links.set(9, 3, {}, kBegin);
  CHECK(links.any());
  REQUIRE(links.find(1, 0));
  CHECK(*links.find(1, 0) == slow);
  CHECK(links.find(9, 3));
  CHECK_FALSE(links.find(0, 1));
  CHECK_FALSE(links.find(3, 20));
}

TEST_CASE("a paused process does nothing and after the pause handles all messages and timers in order") {
  Rig rig;
  int fired = 0;
  rig.far.at(kBegin + 100ms, [&] { ++fired; });
  rig.far.pause(kBegin + 500ms, 1000);
  rig.sender.at(kBegin + 499ms, [&] {
    CHECK(rig.far_received.empty());
    CHECK(fired == 0);
  });
  rig.send(50);
  CHECK(fired == 1);
  REQUIRE(rig.far_received.size() == 50);
  CHECK(std::ranges::is_sorted(rig.far_received));
  CHECK(rig.far_delays_s.back() == Approx(0.45).margin(0.002));
  CHECK(rig.near_received.size() == 50);
}

TEST_CASE("a shorter or longer pause during a pause does not end it early and does not reorder messages") {
  const bool is_longer = GENERATE(false, true);
  CAPTURE(is_longer);
  Rig rig;
  rig.far.pause(kBegin + 300ms, 1000);
  rig.sender.at(kBegin + 20ms, [&] { rig.far.pause(kBegin + (is_longer ? 500ms : 200ms), 1000); });
  rig.sender.at(kBegin + (is_longer ? 499ms : 299ms), [&] { CHECK(rig.far_received.empty()); });
  rig.send(50);
  REQUIRE(rig.far_received.size() == 50);
  CHECK(std::ranges::is_sorted(rig.far_received));
}

TEST_CASE("a paused process queues a limited number of messages, and a restarted process is not paused") {
  Rig rig;
  rig.far.pause(kBegin + 500ms, 10);
  rig.send(50);
  CHECK(rig.far_received.size() == 10);
  CHECK(rig.far_received.back() == 10);
  rig.send(50);
  CHECK(rig.far_received.size() == 60);

  rig.far.pause(rig.network.now() + 60s, 10);
  SimBus restarted(rig.network, {rig.ids[2]});
  int received = 0;
  restarted.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState&) { ++received; }));
  rig.send(50);
  CHECK(received == 50);
}

TEST_CASE("a process has its own clock, and its timers follow that clock") {
  SimNetwork network(1, kBegin, {});
  SimBus ahead(network, {network.new_process(), 30ms}), behind(network, {network.new_process(), -30ms});
  CHECK(ahead.now() == kBegin + 30ms);
  CHECK(behind.now() == kBegin - 30ms);
  Time ahead_fired{}, behind_fired{};
  ahead.at(kBegin + 100ms, [&] { ahead_fired = network.now(); });
  behind.at(kBegin + 100ms, [&] { behind_fired = network.now(); });
  network.run_until(kBegin + 1s);
  CHECK(ahead_fired == kBegin + 70ms);
  CHECK(behind_fired == kBegin + 130ms);
}

TEST_CASE("an observer receives every message without delay even on a bad network") {
  SimNetwork network(1, kBegin, {0.9, 0, 100ms, 200ms});
  SimBus sender(network), observer(network);
  observer.become_observer();
  std::uint64_t received = 0;
  observer.subscribe(topics::kCoordinator, std::function([&](const msg::CoordinatorState& s) {
                       CHECK(s.epoch() == ++received);
                       CHECK(to_ns(network.now()) == s.header().stamp_ns());
                     }));
  auto writer = sender.advertise(topics::kCoordinator);
  for (std::uint64_t n = 1; n <= 100; ++n) {
    sender.at(kBegin + Duration{1ms} * n, [&, n] {
      msg::CoordinatorState state;
      state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
      state.epoch(n);
      writer.publish(state, sender.now());
    });
  }
  network.run_until(kBegin + 1s);
  CHECK(received == 100);
}

/// Two processes that send each other numbered reliable messages.
struct ReliablePair {
  SimNetwork network{1, kBegin, {}};
  ProcessId ids[2] = {network.new_process(), network.new_process()};
  SimBus a{network, {ids[0]}}, b{network, {ids[1]}};
  Writer<msg::AbsenceAttestation> from_a = a.advertise(topics::kAttestation),
                                  from_b = b.advertise(topics::kAttestation);
  std::vector<std::uint64_t> at_a, at_b;

  ReliablePair() {
    a.subscribe(topics::kAttestation, [this](const msg::AbsenceAttestation& m) {
      if (m.robot() == 1) at_a.push_back(m.header().incarnation());
    });
    b.subscribe(topics::kAttestation, [this](const msg::AbsenceAttestation& m) {
      if (m.robot() == 0) at_b.push_back(m.header().incarnation());
    });
  }
  void send(std::uint64_t number) {
    msg::AbsenceAttestation message;
    message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
    message.header().incarnation(number);
    from_a.publish(message, a.now());
    message.robot(1);
    from_b.publish(message, b.now());
  }
  /// Cuts the link from a to b.
  void set_cut(bool is_cut) {
    LinkQuality quality;
    quality.is_cut = is_cut;
    network.set_link(ids[0], ids[1], quality);
  }
  void run_for(Duration duration) { network.run_until(network.now() + duration); }
};

TEST_CASE("reliable messages survive a silence of less than six seconds in one direction") {
  ReliablePair pair;
  pair.set_cut(true);
  pair.send(1);
  pair.run_for(5900ms);
  CHECK(pair.at_b.empty());
  CHECK(pair.at_a == std::vector<std::uint64_t>{1});
  pair.set_cut(false);
  pair.run_for(1s);
  CHECK(pair.at_b == std::vector<std::uint64_t>{1});
}

TEST_CASE("processes forget each other after a silence of six seconds in one direction") {
  ReliablePair pair;
  pair.set_cut(true);
  pair.send(1);
  pair.run_for(6100ms);
  pair.send(2);  // b has forgotten a, so a receives nothing
  pair.run_for(100ms);
  pair.set_cut(false);
  pair.send(3);  // a and b have not discovered each other again
  pair.run_for(3s);
  pair.send(4);
  pair.run_for(1s);
  CHECK(pair.at_a == std::vector<std::uint64_t>{1, 4});
  CHECK(pair.at_b == std::vector<std::uint64_t>{4});
}

TEST_CASE("a short cut right after a start delays discovery, but a later cut does not") {
  ReliablePair pair;
  pair.run_for(10s);
  SimBus late(pair.network, {pair.network.new_process()});
  std::vector<std::uint64_t> received;
  late.subscribe(topics::kAttestation, [&](const msg::AbsenceAttestation& m) {
    if (m.robot() == 0) received.push_back(m.header().incarnation());
  });
  LinkQuality cut;
  cut.is_cut = true;
  pair.run_for(1ms);
  pair.network.set_link(pair.ids[0], 2, cut);
  pair.run_for(1s);
  pair.send(1);
  pair.network.set_link(pair.ids[0], 2, {});
  pair.run_for(3s);
  pair.send(2);
  pair.network.set_link(pair.ids[0], 2, cut);
  pair.send(3);
  pair.run_for(1s);
  pair.network.set_link(pair.ids[0], 2, {});
  pair.run_for(1s);
  CHECK(received == std::vector<std::uint64_t>{2, 3});
}

TEST_CASE("reliable messages do not change the losses and delays of other messages") {
  const auto run = [](bool with_heartbeats) {
    SimNetwork network(1, kBegin, {0.3, 0.1, 1ms, 20ms});
    SimBus sender(network), receiver(network);
    std::vector<std::pair<std::uint64_t, Time>> received;
    receiver.subscribe(topics::kCoordinator, [&](const msg::CoordinatorState& state) {
      received.emplace_back(state.epoch(), network.now());
    });
    // Each message of either topic draws one random delay.
    const auto& topic = topics::kAttestation;
    receiver.subscribe(topic, [](const msg::AbsenceAttestation&) {});
    auto writer = sender.advertise(topics::kCoordinator);
    auto reliable = sender.advertise(topic);
    for (std::uint64_t n = 1; n <= 500; ++n) {
      msg::CoordinatorState state;
      state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator));
      state.epoch(n);
      writer.publish(state, sender.now());
      msg::AbsenceAttestation message;
      message.header().sender(static_cast<std::uint32_t>(Sender::kOperator));
      message.robot(static_cast<std::uint32_t>(n));
      reliable.publish(message, sender.now());
      if (with_heartbeats) network.run_until(network.now() + 1ms);
    }
    network.run_until(network.now() + 10s);
    std::vector<std::uint64_t> numbers;
    for (const auto& [number, time] : received) numbers.push_back(number);
    std::ranges::sort(numbers);
    return numbers;
  };
  // With pauses of 1 ms, heartbeats and resent reliable messages are sent between the states.
  CHECK(run(true) == run(false));
}

}  // namespace sidestep::links_test
