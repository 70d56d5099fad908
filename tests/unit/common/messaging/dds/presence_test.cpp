// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/dds/presence.hpp"

#include <deque>
#include <functional>
#include <map>
#include <set>
#include <utility>

#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::presence_test {

using namespace std::chrono_literals;
using Kind = PresenceNotice::Kind;

constexpr ParticipantId kSelf{1}, kOther{2};

PresenceNotice forgotten(const ParticipantId& whom, std::uint64_t number) {
  return {whom, Kind::kForgotten, number};
}

/// A presence that is checked twice a second, as over DDS.
struct TimedPresence {
  void run_until(Time when) {
    for (; now < when; now += 500ms) {
      for (const ParticipantId& id : presence.newly_silent(now)) removed.insert(id);
    }
  }
  bool hears(std::span<const PresenceNotice> notices) {
    return presence.on_announcement(kSelf, kOther, notices, now);
  }

  Presence presence;
  Time now = time_from_ns(0) + 1h;
  std::multiset<ParticipantId> removed;
};

TEST_CASE("a participant that announces no presence is never refused or forgotten") {
  TimedPresence a;
  CHECK(a.presence.accept(kOther, a.now));
  a.run_until(a.now + 1h);
  CHECK(a.removed.empty());
  CHECK(a.presence.accept(kOther, a.now));
  CHECK(a.presence.notices(a.now).empty());
}

TEST_CASE("a silent participant is removed once and refused until it confirms that it has forgotten us") {
  TimedPresence a;
  CHECK_FALSE(a.hears({}));
  a.run_until(a.now + kSilenceLimit - 1s);
  CHECK(a.presence.accept(kOther, a.now));  // any datagram is a sign of life
  a.run_until(a.now + kSilenceLimit - 1s);
  CHECK(a.removed.empty());
  a.run_until(a.now + 1min);
  CHECK(a.removed.count(kOther) == 1);
  CHECK(a.presence.notices(a.now).empty());  // it may be dead, so it gets no notice

  CHECK_FALSE(a.presence.accept(kOther, a.now));
  const auto notices = a.presence.notices(a.now);
  REQUIRE(notices.size() == 1);
  CHECK(notices[0].whom == kOther);
  CHECK(notices[0].kind == Kind::kForgotten);
  const PresenceNotice outdated{kSelf, Kind::kAgreed, notices[0].number + 1};
  CHECK_FALSE(a.hears(std::array{outdated}));
  CHECK_FALSE(a.presence.accept(kOther, a.now));
  CHECK_FALSE(a.hears(std::array{PresenceNotice{kOther, Kind::kAgreed, notices[0].number}}));  // not to us
  CHECK_FALSE(a.presence.accept(kOther, a.now));
  CHECK_FALSE(a.hears(std::array{PresenceNotice{kSelf, Kind::kAgreed, notices[0].number}}));
  CHECK(a.presence.accept(kOther, a.now));
}

TEST_CASE("a participant that was forgotten removes the other side once and confirms the removal") {
  TimedPresence a;
  CHECK_FALSE(a.hears({}));
  CHECK(a.hears(std::array{forgotten(kSelf, 7)}));
  CHECK_FALSE(a.presence.accept(kOther, a.now));  // the datagram may be older than the notice
  CHECK(a.presence.notices(a.now).empty());
  a.run_until(a.now + 500ms);
  CHECK_FALSE(a.hears(std::array{forgotten(kSelf, 7)}));  // repeated, because our answer was lost
  CHECK(a.presence.accept(kOther, a.now));
  const auto notices = a.presence.notices(a.now);
  REQUIRE(notices.size() == 1);
  CHECK(notices[0] == PresenceNotice{kOther, Kind::kAgreed, 7});
  CHECK(a.hears(std::array{forgotten(kSelf, 8)}));
  CHECK(a.hears(std::array{forgotten(kSelf, 9), forgotten(kSelf, 9)}));
}

TEST_CASE("a process that was stopped itself does not forget other processes") {
  TimedPresence a;
  CHECK_FALSE(a.hears({}));
  a.run_until(a.now + 1s);
  a.now += 1h;
  a.run_until(a.now + 1s);
  CHECK(a.removed.empty());
  CHECK(a.presence.accept(kOther, a.now));
}

TEST_CASE("the number of remembered forgotten participants is bounded, and the oldest are dropped first") {
  TimedPresence a;
  const auto id = [](std::size_t i) {
    return ParticipantId{9, static_cast<std::uint8_t>(i >> 8), static_cast<std::uint8_t>(i)};
  };
  for (std::size_t i = 0; i < Presence::kMaxPeers; ++i) {
    CHECK_FALSE(a.presence.on_announcement(kSelf, id(i), {}, a.now));
    if (i < 2) a.run_until(a.now + kSilenceLimit + 1s);
  }
  CHECK(a.removed.size() == 2);
  CHECK_FALSE(a.presence.accept(id(0), a.now));
  CHECK_FALSE(a.presence.on_announcement(kSelf, id(5000), {}, a.now));
  CHECK(a.presence.accept(id(0), a.now));        // forgotten itself
  CHECK_FALSE(a.presence.accept(id(1), a.now));  // still refused
  for (std::size_t i = 0; i < Presence::kMaxPeers; ++i) {
    if (i != 1) CHECK(a.presence.accept(id(i), a.now));
  }
}

TEST_CASE("an announcement names a bounded number of participants") {
  TimedPresence a;
  const auto id = [](std::uint8_t i) { return ParticipantId{9, i}; };
  for (int i = 0; i < 200; ++i)
    CHECK_FALSE(a.presence.on_announcement(kSelf, id(static_cast<std::uint8_t>(i)), {}, a.now));
  a.run_until(a.now + kSilenceLimit + 1s);
  for (int i = 0; i < 200; ++i) CHECK_FALSE(a.presence.accept(id(static_cast<std::uint8_t>(i)), a.now));
  const std::size_t count = a.presence.notices(a.now).size();
  CHECK(count <= Presence::kMaxNotices);
  CHECK(count >= Presence::kMaxNotices / 2);
}

/// Two participants and a model of the knowledge of Fast DDS. Each side counts how often it has removed the
/// other side. The sides are matched if each has discovered the other since the other last removed it; if
/// only one side removes the other, they stay unmatched. Each side also acknowledges its knowledge, and the
/// acknowledgement arrives late. A side that takes an acknowledgement from before a removal for a newer
/// acknowledgement is misled permanently.
struct Pair {
  struct Side {
    Presence presence;
    ParticipantId id{};
    bool knows = false;       ///< whether this side knows the other side
    int generation = 0;       ///< number of times that this side removed the other
    int seen_generation = 0;  ///< the other side's generation when this side discovered it
    bool is_misled = false;   ///< misled by an outdated acknowledgement
    bool is_stopped = false, was_stopped = false;
    Time next_announcement{};
    std::multimap<Time, std::function<void()>> late;
    std::deque<std::function<void()>> arrived;  ///< messages that arrived while the side was stopped
  };

  explicit Pair(std::uint64_t seed) : rng(seed) {
    sides[0].id = kSelf;
    sides[1].id = kOther;
  }

  void remove(Side& at) {
    at.is_misled = false;
    if (std::exchange(at.knows, false)) ++at.generation;
  }

  void announce(Side& from, Side& to) {
    const auto notices = from.presence.notices(now);
    const int generation = from.generation;
    deliver(from, to, [this, &from, &to, notices] {
      if (to.presence.on_announcement(to.id, from.id, notices, now)) remove(to);
    });
    deliver(from, to, [this, &from, &to, generation] {
      if (!to.presence.accept(from.id, now) || to.knows) return;
      to.knows = true;
      to.seen_generation = generation;
    });
  }

  Time soon() { return now + Duration{static_cast<std::int64_t>(rng.uniform(0, 250e6))}; }

  void acknowledge(Side& from, Side& to) {
    if (!from.knows || is_cut[&from - sides] || rng.chance(loss)) return;
    to.late.emplace(soon(), [this, &from, &to, generation = from.generation] {
      if (to.presence.accept(from.id, now) && to.knows && generation != to.seen_generation)
        to.is_misled = true;
    });
  }

  void deliver(const Side& from, Side& to, std::function<void()> what) {
    if (is_cut[&from - sides] || rng.chance(loss)) return;
    if (to.is_stopped)
      to.arrived.push_back(std::move(what));
    else
      what();
  }

  void step() {
    now += 50ms;
    for (int i = 0; i < 2; ++i) {
      Side& side = sides[i];
      if (side.is_stopped) {
        side.was_stopped = true;
        continue;
      }
      for (; !side.arrived.empty(); side.arrived.pop_front()) side.arrived.front()();
      if (std::exchange(side.was_stopped, false)) {
        // It soon reads the messages waiting in its sockets, but not in the order of sending.
        for (auto& [when, what] : std::exchange(side.late, {})) side.late.emplace(soon(), std::move(what));
      }
      for (; !side.late.empty() && side.late.begin()->first <= now; side.late.erase(side.late.begin()))
        side.late.begin()->second();
      acknowledge(side, sides[1 - i]);
      if (now < side.next_announcement) continue;
      side.next_announcement = now + 1s;
      if (!side.presence.newly_silent(now).empty()) remove(side);
      announce(side, sides[1 - i]);
    }
  }

  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) step();
  }

  bool are_matched() const {
    return !sides[0].is_misled && !sides[1].is_misled && sides[0].knows && sides[1].knows &&
           sides[0].seen_generation == sides[1].generation && sides[1].seen_generation == sides[0].generation;
  }

  Rng rng;
  Side sides[2];
  bool is_cut[2] = {false, false};  ///< messages from this side are lost
  double loss = 0;
  Time now = time_from_ns(0) + 1h;
};

TEST_CASE("two participants find each other again after stops and cuts of any duration") {
  const std::uint64_t seed = GENERATE(range(1, 200));
  CAPTURE(seed);
  Pair pair(seed);
  pair.run(3s);
  REQUIRE(pair.are_matched());
  int times_forgotten = 0;
  for (int fault = 0; fault < 20; ++fault) {
    CAPTURE(fault);
    pair.loss = pair.rng.chance(0.5) ? 0 : 0.3;
    for (int side = 0; side < 2; ++side) {
      pair.sides[side].is_stopped = pair.rng.chance(0.3);
      pair.is_cut[side] = pair.rng.chance(0.3);
    }
    const int before = pair.sides[0].generation + pair.sides[1].generation;
    pair.run(Duration{100'000'000} * static_cast<int>(pair.rng.below(200)));
    for (int side = 0; side < 2; ++side) pair.sides[side].is_stopped = pair.is_cut[side] = false;
    pair.run(pair.loss > 0 ? Duration{30s} : Duration{5s});
    CAPTURE(pair.sides[0].is_misled, pair.sides[1].is_misled, pair.sides[0].knows, pair.sides[1].knows);
    CAPTURE(pair.sides[0].generation, pair.sides[1].seen_generation, pair.sides[1].generation,
            pair.sides[0].seen_generation, pair.loss);
    REQUIRE(pair.are_matched());
    times_forgotten += pair.sides[0].generation + pair.sides[1].generation - before;
  }
  CHECK(times_forgotten > 0);
}

}  // namespace sidestep::presence_test
