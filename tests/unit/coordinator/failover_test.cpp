// SPDX-License-Identifier: Apache-2.0
#include "coordinator/failover.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/messaging/senders.hpp"
#include "common/random/rng.hpp"

using namespace sidestep;

namespace {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kHour{3'600'000'000'000};

Time after_ms(double ms) { return kBegin + from_seconds(ms / 1000); }

msg::CoordinatorState sign(Epoch epoch, CoordinatorNumber number = 0, Incarnation incarnation = 7) {
  msg::CoordinatorState state;
  state.coordinator(number);
  state.head().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + number);
  state.head().incarnation(incarnation);
  state.epoch(epoch);
  state.coordinator_mode(epoch == 0 ? msg::COORDINATOR_STANDBY : msg::COORDINATOR_GRANTING);
  return state;
}

/// A standby that looks every 5 ms, as its process does.
struct Standby {
  Failover failover{{1, 99}, true, kBegin};
  double now_ms = 0;

  /// Looks until a time; the sign of life of an epoch comes every 20 ms, if one is given.
  void look_until(double ms, Epoch heard = 0) {
    for (; now_ms <= ms; now_ms += 5) {
      if (heard != 0 && static_cast<int>(now_ms) % 20 == 0)
        failover.on_coordinator_state(sign(heard), after_ms(now_ms));
      failover.update(after_ms(now_ms));
    }
  }
  /// When it took over, in ms.
  double take_over_ms() {
    const double begin = now_ms;
    while (!failover.is_active() && now_ms < begin + 100'000) look_until(now_ms);
    return now_ms - 5;
  }
};

constexpr Epoch kEpoch = 1'000'000'000'000;

}  // namespace

TEST_CASE("an active coordinator begins an epoch at once, a standby waits a second for others") {
  Failover active({0, 5}, false, kBegin);
  CHECK(active.is_active());
  CHECK(active.epoch() >= static_cast<Epoch>(to_ns(kBegin)));
  Standby standby;
  standby.look_until(900);
  CHECK_FALSE(standby.failover.is_active());
  CHECK(standby.take_over_ms() < 1500);
  CHECK(standby.failover.epoch() >= static_cast<Epoch>(to_ns(kBegin)));
}

TEST_CASE("a standby takes over within 170 ms of the last sign of life, above the epoch that it heard") {
  Standby standby;
  const Epoch heard = kEpoch + 5'000'000'000'000;  // its clock is ahead by more than an hour: nobody's
  standby.look_until(300, heard);
  CHECK(standby.failover.invalid() > 0);
  const Epoch ahead = kEpoch + 60'000'000'000;
  standby.look_until(2000, ahead);
  CHECK_FALSE(standby.failover.is_active());
  const double waited_ms = standby.take_over_ms() - 2000;
  CAPTURE(waited_ms);
  CHECK(waited_ms >= 120);
  CHECK(waited_ms <= 170);
  CHECK(standby.failover.epoch() > ahead);
}

TEST_CASE("signs of life of standbys and of those that were superseded keep nobody from taking over") {
  Standby standby;
  standby.look_until(1000, kEpoch + 100);
  const auto old = sign(kEpoch + 50), other_standby = sign(0, 2);
  for (double ms = 1000; ms < 1300; ms += 5) {
    standby.failover.on_coordinator_state(old, after_ms(ms));
    standby.failover.on_coordinator_state(other_standby, after_ms(ms));
    standby.look_until(ms);
  }
  CHECK(standby.failover.is_active());
}

TEST_CASE("where signs of life come irregularly a standby waits longer") {
  Standby standby;
  for (int i = 0; i < 40; ++i) {
    standby.failover.on_coordinator_state(sign(kEpoch), after_ms(standby.now_ms));
    standby.look_until(standby.now_ms + (i % 2 == 0 ? 100 : 15));
  }
  REQUIRE_FALSE(standby.failover.is_active());
  CHECK(standby.failover.lapse() >= std::chrono::milliseconds(200));
  // Once they come regularly again it is as quick as before.
  standby.look_until(standby.now_ms + 1500, kEpoch);
  CHECK(standby.failover.lapse() < std::chrono::milliseconds(160));
}

TEST_CASE("a standby that was not run for a while first hears what has come meanwhile") {
  Standby standby;
  standby.look_until(1000, kEpoch);
  standby.failover.update(after_ms(4000));
  CHECK_FALSE(standby.failover.is_active());
  standby.now_ms = 4005;
  standby.look_until(5000, kEpoch);
  CHECK_FALSE(standby.failover.is_active());
}

TEST_CASE("a coordinator that hears of a higher epoch stands by, and comes back when nobody is there") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  active.on_coordinator_state(sign(own, 0, 5), after_ms(1));  // itself
  CHECK(active.epoch() == own);
  active.on_coordinator_state(sign(own - 8, 1), after_ms(1));
  CHECK(active.epoch() == own);
  active.on_coordinator_state(sign(own + 1, 1), after_ms(1));
  CHECK_FALSE(active.is_active());
  for (double ms = 5; ms < 400; ms += 5) active.update(after_ms(ms));
  CHECK(active.epoch() > own + 1);
}

TEST_CASE("an epoch that agents obey is begun above, or yielded to by one that grants already") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  active.on_obeyed_epoch(own - 1, false, kBegin);
  CHECK(active.epoch() == own);
  active.on_obeyed_epoch(own + 1000, false, kBegin);
  const Epoch risen = active.epoch();
  CHECK(risen > own + 1000);
  active.on_obeyed_epoch(risen + 1000, true, kBegin);
  CHECK_FALSE(active.is_active());
  const Duration first = active.lapse();
  Duration last = first;
  // It yields for longer each time that it does not hear who it yields to, but not for ever.
  Time now = kBegin;
  for (int i = 0; i < 10; ++i) {
    const Time yielded = now;
    while (!active.is_active()) active.update(now += std::chrono::milliseconds(5));
    CHECK(now - yielded >= last);
    active.on_obeyed_epoch(active.epoch() + 1000, true, now);
    CHECK(active.lapse() >= last);
    last = active.lapse();
  }
  CHECK(last >= 16 * first);
  CHECK(last < std::chrono::seconds(6));
  active.on_coordinator_state(sign(active.epoch() + kEpoch + 100'000'000'000, 1), now);
  CHECK(active.lapse() < std::chrono::milliseconds(300));
}

TEST_CASE("two coordinators never share an epoch, and should they all the same the epoch is given up") {
  Rng rng(3);
  std::set<Epoch> epochs;
  for (int round = 0; round < 200; ++round) {
    const Epoch obeyed = kEpoch + rng.below(1'000'000'000);
    for (CoordinatorNumber number = 0; number < kMaxCoordinators; ++number) {
      Failover one({number, rng.bits()}, false, kBegin + Duration{8 * round});
      CHECK(epochs.insert(one.epoch()).second);
      one.on_obeyed_epoch(obeyed, false, kBegin);
      CHECK(one.epoch() > obeyed);
      CHECK(epochs.insert(one.epoch()).second);
    }
  }
  Failover earlier({2, 5}, false, kBegin), later({2, 6}, false, kBegin);
  const Epoch shared = earlier.epoch();
  REQUIRE(later.epoch() == shared);
  earlier.on_coordinator_state(sign(shared, 2, 6), after_ms(1));
  later.on_coordinator_state(sign(shared, 2, 5), after_ms(1));
  CHECK_FALSE(earlier.is_active());
  CHECK(later.epoch() > shared);
}

TEST_CASE("hostile epochs far ahead are nobody's, and less hostile ones cost one change of epoch each") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  for (const Epoch hostile : {Epoch{1} << 61, (Epoch{1} << 62) - 1, Epoch{1} << 62, ~Epoch{0},
                              static_cast<Epoch>(to_ns(kBegin + kHour))}) {
    active.on_coordinator_state(sign(hostile, 3), kBegin);
    active.on_obeyed_epoch(hostile, true, kBegin);
    active.on_obeyed_epoch(hostile, false, kBegin);
    CHECK(active.epoch() == own);
  }
  CHECK(active.invalid() == 15);
  const auto just_believable = static_cast<Epoch>(to_ns(kBegin + kHour)) - 1;
  active.on_coordinator_state(sign(just_believable, 3), kBegin);
  CHECK_FALSE(active.is_active());
  Time now = kBegin;
  while (!active.is_active() && now < kBegin + std::chrono::seconds(5))
    active.update(now += std::chrono::milliseconds(5));
  CHECK(active.epoch() > just_believable);
  // By the time that others hear of it they believe it.
  CHECK(is_believable(active.epoch(), now));
}
