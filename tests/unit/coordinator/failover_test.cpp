// SPDX-License-Identifier: Apache-2.0
#include "coordinator/failover.hpp"

#include <map>
#include <set>

#include "common/messaging/negotiation_codec.hpp"
#include "common/protocol/senders.hpp"
#include "common/random/rng.hpp"
#include "tests/catch.hpp"

namespace sidestep::failover_test {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Duration kHour{3'600'000'000'000};

Time after_ms(double ms) { return kBegin + from_seconds(ms / 1000); }

msg::CoordinatorState heartbeat(Epoch epoch, CoordinatorNumber number = 0, Incarnation incarnation = 7) {
  msg::CoordinatorState state;
  state.coordinator(number);
  state.header().sender(static_cast<std::uint32_t>(Sender::kCoordinator) + number);
  state.header().incarnation(incarnation);
  state.epoch(epoch);
  state.coordinator_mode(epoch == 0 ? msg::CoordinatorMode::COORDINATOR_STANDBY
                                    : msg::CoordinatorMode::COORDINATOR_GRANTING);
  return state;
}

/// Decodes a heartbeat as CoordinatorNode does. Returns false if the heartbeat is refused.
bool receive(Failover& failover, const msg::CoordinatorState& message, Time now) {
  const auto heartbeat = decode(message, now);
  if (heartbeat) failover.on_heartbeat(*heartbeat, now);
  return heartbeat.has_value();
}

/// Updates a coordinator that hears robots.
void update(Failover& failover, Time now) {
  failover.reception().on_robot_report(7, 1, false, now);
  failover.update(now);
}

/// A standby that hears robots. Its update() is called every 5 ms, as in its process.
struct Standby {
  Failover failover{{1, 99}, true, kBegin};
  double now_ms = 0;
  int refused = 0;

  /// Runs until this time. Every 20 ms a heartbeat of the epoch `other` arrives, unless `other` is 0.
  void run_until(double ms, Epoch other = 0) {
    for (; now_ms <= ms; now_ms += 5) {
      if (other != 0 && static_cast<int>(now_ms) % 20 == 0)
        refused += !receive(failover, heartbeat(other), after_ms(now_ms));
      update(failover, after_ms(now_ms));
    }
  }
  /// Runs until the standby takes over. Returns the time of the takeover in ms.
  double run_until_takeover_ms() {
    const double begin = now_ms;
    while (!failover.is_active() && now_ms < begin + 100'000) run_until(now_ms);
    return now_ms - 5;
  }
};

constexpr Epoch kEpoch = 1'000'000'000'000;

TEST_CASE(
    "an active coordinator begins an epoch immediately, but a standby first waits a second for others") {
  Failover active({0, 5}, false, kBegin);
  CHECK(active.is_active());
  CHECK(active.epoch() >= static_cast<Epoch>(to_ns(kBegin)));
  Standby standby;
  standby.run_until(900);
  CHECK_FALSE(standby.failover.is_active());
  CHECK(standby.run_until_takeover_ms() < 1500);
  CHECK(standby.failover.epoch() >= static_cast<Epoch>(to_ns(kBegin)));
}

TEST_CASE("a standby takes over with a higher epoch within 170 ms of the last heartbeat") {
  Standby standby;
  const Epoch implausible = kEpoch + 5'000'000'000'000;  // more than an hour ahead of the clock
  standby.run_until(300, implausible);
  CHECK(standby.refused > 0);
  const Epoch ahead = kEpoch + 60'000'000'000;
  standby.run_until(2000, ahead);
  CHECK_FALSE(standby.failover.is_active());
  const double waited_ms = standby.run_until_takeover_ms() - 2000;
  CAPTURE(waited_ms);
  CHECK(waited_ms >= 120);
  CHECK(waited_ms <= 170);
  CHECK(standby.failover.epoch() > ahead);
}

TEST_CASE("heartbeats of standbys and of superseded coordinators do not prevent a takeover") {
  Standby standby;
  standby.run_until(1000, kEpoch + 100);
  const auto old = heartbeat(kEpoch + 50), other_standby = heartbeat(0, 2);
  for (double ms = 1000; ms < 1300; ms += 5) {
    receive(standby.failover, old, after_ms(ms));
    receive(standby.failover, other_standby, after_ms(ms));
    standby.run_until(ms);
  }
  CHECK(standby.failover.is_active());
}

TEST_CASE("a coordinator knows the reason for its role") {
  using enum msg::RoleReason;
  const auto reason_of = [](const Failover& failover) { return failover.cause().reason; };
  Failover active({0, 5}, false, kBegin);
  CHECK(reason_of(active) == ROLE_STARTED);

  Standby standby;
  CHECK(reason_of(standby.failover) == ROLE_STARTED);
  SECTION("a standby has heard no coordinator since its start") {
    standby.run_until_takeover_ms();
    CHECK(reason_of(standby.failover) == ROLE_NO_COORDINATOR);
    CHECK(standby.failover.cause().silence >= std::chrono::milliseconds(1200));
  }
  SECTION("a standby hears no more heartbeats") {
    standby.run_until(2000, kEpoch);
    standby.run_until_takeover_ms();
    CHECK(reason_of(standby.failover) == ROLE_HEARTBEATS_LOST);
    CHECK(standby.failover.cause().peer == 0);
    CHECK(standby.failover.cause().silence >= std::chrono::milliseconds(140));
    CHECK(standby.failover.cause().silence <= std::chrono::milliseconds(170));
    CHECK_THAT(describe(standby.failover.cause()), ContainsSubstring("no heartbeat of coordinator 0 for 1"));
  }
  SECTION("a robot or an agent knows a higher epoch before the coordinator grants") {
    const auto holder = GENERATE(EpochHolder::kRobot, EpochHolder::kAgent);
    const Epoch higher = active.epoch() + 1000;
    active.on_obeyed_epoch(higher, false, kBegin, 7, holder);
    REQUIRE(active.is_active());
    CHECK(reason_of(active) == (holder == EpochHolder::kRobot ? ROLE_EPOCH_OF_ROBOT : ROLE_EPOCH_OF_AGENT));
    CHECK(active.cause().peer == 7);
    CHECK(active.cause().learned == higher);
  }
  SECTION(
      "a robot knows a higher epoch while the coordinator grants, so the coordinator yields and returns") {
    active.on_obeyed_epoch(active.epoch() + 1000, true, kBegin, 7, EpochHolder::kRobot);
    REQUIRE_FALSE(active.is_active());
    CHECK(reason_of(active) == ROLE_EPOCH_OF_ROBOT);
    for (double ms = 5; !active.is_active() && ms < 1000; ms += 5) update(active, after_ms(ms));
    REQUIRE(active.is_active());
    CHECK(reason_of(active) == ROLE_RETURNED);
    CHECK(active.cause().silence >= std::chrono::milliseconds(200));
  }
  SECTION("another coordinator has a higher epoch") {
    receive(active, heartbeat(active.epoch() + 1, 3), after_ms(1));
    REQUIRE_FALSE(active.is_active());
    CHECK(reason_of(active) == ROLE_EPOCH_OF_COORDINATOR);
    CHECK(active.cause().peer == 3);
  }
  SECTION("a process with the same coordinator number has begun the same epoch") {
    Failover later({0, 6}, false, kBegin);
    const Epoch shared = active.epoch();
    receive(active, heartbeat(shared, 0, 6), after_ms(1));
    receive(later, heartbeat(shared, 0, 5), after_ms(1));
    CHECK_FALSE(active.is_active());
    CHECK(later.is_active());
    CHECK(reason_of(active) == ROLE_SHARED_EPOCH);
    CHECK(reason_of(later) == ROLE_SHARED_EPOCH);
  }
}

TEST_CASE("a standby waits longer if heartbeats are irregular") {
  Standby standby;
  for (int i = 0; i < 40; ++i) {
    receive(standby.failover, heartbeat(kEpoch), after_ms(standby.now_ms));
    standby.run_until(standby.now_ms + (i % 2 == 0 ? 100 : 15));
  }
  REQUIRE_FALSE(standby.failover.is_active());
  CHECK(standby.failover.takeover_timeout() >= std::chrono::milliseconds(200));
  // With regular heartbeats, the timeout recovers.
  standby.run_until(standby.now_ms + 1500, kEpoch);
  CHECK(standby.failover.takeover_timeout() < std::chrono::milliseconds(160));
}

TEST_CASE("a standby that was paused processes queued heartbeats before it may take over") {
  Standby standby;
  standby.run_until(1000, kEpoch);
  update(standby.failover, after_ms(4000));
  CHECK_FALSE(standby.failover.is_active());
  standby.now_ms = 4005;
  standby.run_until(5000, kEpoch);
  CHECK_FALSE(standby.failover.is_active());
}

TEST_CASE("a coordinator yields to a higher epoch and takes over again when the heartbeats stop") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  receive(active, heartbeat(own, 0, 5), after_ms(1));  // the coordinator's own heartbeat
  CHECK(active.epoch() == own);
  receive(active, heartbeat(own - 8, 1), after_ms(1));
  CHECK(active.epoch() == own);
  receive(active, heartbeat(own + 1, 1), after_ms(1));
  CHECK_FALSE(active.is_active());
  for (double ms = 5; ms < 400; ms += 5) update(active, after_ms(ms));
  CHECK(active.epoch() > own + 1);
}

TEST_CASE(
    "a coordinator that learns a higher obeyed epoch raises its own epoch, or yields if it already grants") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  active.on_obeyed_epoch(own - 1, false, kBegin, 7, EpochHolder::kRobot);
  CHECK(active.epoch() == own);
  active.on_obeyed_epoch(own + 1000, false, kBegin, 7, EpochHolder::kRobot);
  const Epoch raised = active.epoch();
  CHECK(raised > own + 1000);
  active.on_obeyed_epoch(raised + 1000, true, kBegin, 7, EpochHolder::kRobot);
  CHECK_FALSE(active.is_active());
  const Duration first = active.takeover_timeout();
  Duration last = first;
  // If no heartbeats of another coordinator arrive, the coordinator yields for a longer time after each
  // higher epoch, up to a limit.
  Time now = kBegin;
  for (int i = 0; i < 5; ++i) {
    const Time yielded = now;
    while (!active.is_active()) update(active, now += std::chrono::milliseconds(5));
    CHECK(now - yielded >= last);
    now += std::chrono::seconds(5);
    update(active, now);
    active.on_obeyed_epoch(active.epoch() + 1000, true, now, 7, EpochHolder::kRobot);
    CHECK_FALSE(active.is_active());
    CHECK(active.takeover_timeout() >= last);
    last = active.takeover_timeout();
  }
  CHECK(last == 2 * first);
  CHECK(last < std::chrono::seconds(1));
  receive(active, heartbeat(active.epoch() + kEpoch + 100'000'000'000, 1), now);
  CHECK(active.takeover_timeout() < std::chrono::milliseconds(300));
}

TEST_CASE("a coordinator keeps working while another process reports increasing epochs") {
  const bool is_granting = GENERATE(true, false);
  const Duration period = std::chrono::milliseconds(GENERATE(5, 100, 3000));
  CAPTURE(is_granting, to_seconds(period));
  Failover active({0, 5}, false, kBegin);
  int epochs = 0, active_ms = 0;
  constexpr int kDuration_ms = 120'000;
  Time next = kBegin;
  for (int ms = 0; ms < kDuration_ms; ms += 5) {
    const Time now = after_ms(ms);
    const Epoch before = active.epoch();
    for (; next <= now; next += period)
      active.on_obeyed_epoch(static_cast<Epoch>(to_ns(next)) + 10'000'000'000, is_granting, now, 7,
                             EpochHolder::kRobot);
    update(active, now);
    epochs += active.epoch() != 0 && active.epoch() != before;
    active_ms += active.is_active() ? 5 : 0;
  }
  CAPTURE(epochs, active_ms);
  CHECK(epochs > 0);
  CHECK(epochs <= 4 + kDuration_ms / 5000);
  CHECK(active_ms > kDuration_ms * 8 / 10);
  CHECK((active.too_frequent() > 0) == (period < std::chrono::seconds(5)));
}

TEST_CASE("coordinators share an epoch only if they have the same number, and both give it up") {
  Rng rng(3);
  std::set<Epoch> epochs;
  for (int round = 0; round < 200; ++round) {
    const Epoch obeyed = kEpoch + rng.below(1'000'000'000);
    for (CoordinatorNumber number = 0; number < kMaxCoordinators; ++number) {
      Failover one({number, rng.bits()}, false, kBegin + Duration{8 * round});
      CHECK(epochs.insert(one.epoch()).second);
      one.on_obeyed_epoch(obeyed, false, kBegin, 7, EpochHolder::kRobot);
      CHECK(one.epoch() > obeyed);
      CHECK(epochs.insert(one.epoch()).second);
    }
  }
  Failover earlier({2, 5}, false, kBegin), later({2, 6}, false, kBegin);
  const Epoch shared = earlier.epoch();
  REQUIRE(later.epoch() == shared);
  receive(earlier, heartbeat(shared, 2, 6), after_ms(1));
  receive(later, heartbeat(shared, 2, 5), after_ms(1));
  CHECK_FALSE(earlier.is_active());
  CHECK(later.epoch() > shared);
}

TEST_CASE("epochs far ahead are ignored, and each plausible hostile epoch causes one change of epoch") {
  Failover active({0, 5}, false, kBegin);
  const Epoch own = active.epoch();
  for (const Epoch hostile : {Epoch{1} << 61, (Epoch{1} << 62) - 1, Epoch{1} << 62, ~Epoch{0},
                              static_cast<Epoch>(to_ns(kBegin + kHour))}) {
    CHECK_FALSE(receive(active, heartbeat(hostile, 3), kBegin));
    active.on_obeyed_epoch(hostile, true, kBegin, 7, EpochHolder::kRobot);
    active.on_obeyed_epoch(hostile, false, kBegin, 7, EpochHolder::kRobot);
    CHECK(active.epoch() == own);
  }
  CHECK(active.invalid() == 10);
  const auto just_plausible = static_cast<Epoch>(to_ns(kBegin + kHour)) - 1;
  CHECK(receive(active, heartbeat(just_plausible, 3), kBegin));
  CHECK_FALSE(active.is_active());
  Time now = kBegin;
  while (!active.is_active() && now < kBegin + std::chrono::seconds(5))
    update(active, now += std::chrono::milliseconds(5));
  CHECK(active.epoch() > just_plausible);
  // The new epoch must be plausible to other processes.
  CHECK(is_plausible(active.epoch(), now));
}

}  // namespace sidestep::failover_test
