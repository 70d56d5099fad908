// SPDX-License-Identifier: Apache-2.0
// How a coordinator decides whether to take over, based on the messages that it receives.
#include "common/protocol/senders.hpp"
#include "coordinator/failover.hpp"
#include "tests/catch.hpp"

namespace sidestep::takeover_choice_test {

constexpr Time kBegin = time_from_ns(1'000'000'000'000);
constexpr Epoch kEpoch = 1'000'000'000'000;
const std::vector<RobotId> kRoster{1, 2, 3};

/// Coordinator 1, and the senders that it hears in each step of 5 ms.
struct Coordinator {
  Failover failover{{1, 99}, true, kBegin, {kRoster}};
  Time now = kBegin;
  std::vector<RobotId> heard_robots = kRoster, heard_agents = kRoster, asking{};
  Epoch other = 0;                 ///< epoch in coordinator 0's heartbeats; 0 if none arrive
  std::vector<RobotId> missing{};  ///< robots that coordinator 0 has not registered
  bool hears_vision = true, is_fleet_served = false, is_granting = false;
  VersionNumber number = 10;

  void step() {
    now += Failover::kUpdatePeriod;
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(now - kBegin).count();
    if (ms % 15 == 0) {
      number += is_fleet_served ? 1 : 0;
      for (const RobotId robot : heard_robots) failover.reception().on_robot_report(robot, number, true, now);
    }
    if (ms % 1000 == 0)
      for (const RobotId robot : heard_agents) failover.reception().on_agent(robot, now);
    if (ms % 100 == 0)
      for (const RobotId robot : asking) failover.reception().on_registration(robot, now);
    if (ms % 20 == 0 && hears_vision) failover.reception().on_vision(now);
    if (ms % 20 == 0 && other != 0) beat();
    failover.update(now, failover.is_active() && is_granting);
  }
  void beat() {
    std::vector<msg::RobotNotice> notices(missing.size());
    for (std::size_t i = 0; i < missing.size(); ++i) {
      notices[i].robot(missing[i]);
      notices[i].is_missing(true);
    }
    CoordinatorHeartbeat heartbeat;
    heartbeat.sender = static_cast<std::uint32_t>(Sender::kCoordinator);
    heartbeat.epoch = other;
    heartbeat.mode = missing.empty() ? msg::CoordinatorMode::COORDINATOR_GRANTING
                                     : msg::CoordinatorMode::COORDINATOR_REGISTERING;
    heartbeat.notices = notices;
    failover.on_heartbeat(heartbeat, now);
  }
  void run(double seconds) {
    for (const Time end = now + from_seconds(seconds); now < end;) step();
  }
  /// Time until the coordinator becomes active; `limit_s` if it does not.
  double takeover_s(double limit_s) {
    const Time begin = now;
    while (!failover.is_active() && now < begin + from_seconds(limit_s)) step();
    return to_seconds(now - begin);
  }
};

TEST_CASE("a coordinator that hears no robot does not take over until shortly after it hears robots again") {
  Coordinator c;
  c.other = kEpoch;
  c.run(3);
  c.other = 0;
  c.heard_robots.clear();
  c.run(60);
  CHECK_FALSE(c.failover.is_active());
  c.heard_robots = kRoster;
  CHECK(c.takeover_s(1) < 0.1);
}

TEST_CASE("a coordinator that hears only a minority of its former robots does not take over") {
  Coordinator c;
  c.other = kEpoch;
  c.run(3);
  c.other = 0;
  c.heard_robots = {2};
  c.run(5);
  CHECK_FALSE(c.failover.is_active());
}

TEST_CASE("a coordinator that never heard a robot does not begin an epoch") {
  Coordinator c;
  c.heard_robots.clear();
  c.run(20);
  CHECK_FALSE(c.failover.is_active());
  c.heard_robots = {1};
  CHECK(c.takeover_s(1) < 0.1);
}

TEST_CASE("a standby takes over from a coordinator that does not register an agent heard by the standby") {
  Coordinator c;
  c.other = kEpoch;
  c.missing = {2};
  c.heard_agents = {1, 3};
  c.run(3);
  // The agent is dead, so another coordinator could do no better.
  CHECK_FALSE(c.failover.is_active());
  c.asking = {3};  // this agent is registered
  c.run(10);
  CHECK_FALSE(c.failover.is_active());
  c.asking.clear();
  c.run(1);
  c.asking = {2};
  const double waited_s = c.takeover_s(2);
  CHECK(waited_s >= 0.4);
  CHECK(waited_s <= 0.6);
  CHECK(c.failover.epoch() > kEpoch);
  CHECK(c.failover.cause().reason == msg::RoleReason::ROLE_EPOCH_OF_AGENT);
  CHECK(c.failover.cause().peer == 2);
}

TEST_CASE(
    "only a standby that hears all agents and vision replaces a coordinator that fails to serve an agent") {
  const bool hears_agents = GENERATE(true, false), hears_vision = GENERATE(true, false);
  const bool hears_all = hears_agents && hears_vision;
  CAPTURE(hears_agents, hears_vision);
  Coordinator c;
  c.hears_vision = hears_vision;
  c.other = kEpoch;
  c.is_fleet_served = true;
  if (!hears_agents) c.heard_agents = {1, 2};
  c.run(3);
  CHECK_FALSE(c.failover.is_active());
  c.asking = {2};
  const double waited_s = c.takeover_s(5);
  CHECK(c.failover.is_active() == hears_all);
  if (!hears_all) return;
  CHECK(waited_s >= 0.5);
  CHECK(waited_s <= 0.7);
}

TEST_CASE("a standby does not take over while robots begin versions granted by an unheard coordinator") {
  Coordinator c;
  c.other = kEpoch;
  c.is_fleet_served = true;
  c.run(3);
  c.other = 0;
  c.run(10);
  CHECK_FALSE(c.failover.is_active());
  // All robots rest for a moment, or the unheard coordinator has died.
  c.is_fleet_served = false;
  c.run(0.9);
  CHECK_FALSE(c.failover.is_active());
  CHECK(c.takeover_s(1) < 0.2);
}

TEST_CASE("a standby takes over soon after the last heartbeat even if robots begin a few more versions") {
  Coordinator c;
  c.other = kEpoch;
  c.is_fleet_served = true;
  c.run(3);
  c.other = 0;
  c.run(0.1);
  c.is_fleet_served = false;
  CHECK(c.takeover_s(1) < 0.1);
}

TEST_CASE(
    "after each failure to serve, a coordinator waits longer before it takes over again, up to a limit") {
  Coordinator c;
  Epoch epoch = kEpoch;
  c.is_fleet_served = true;
  c.asking = {2};
  double last_s = 0;
  const auto supersede_coordinator = [&] {
    epoch = c.failover.epoch() + 8;
    c.other = epoch;
    c.step();
    while (c.failover.is_active()) c.step();
  };
  c.other = epoch;
  for (int round = 0; round < 6; ++round) {
    CAPTURE(round);
    const double waited_s = c.takeover_s(30);
    REQUIRE(c.failover.is_active());
    CHECK(waited_s >= 0.99 * last_s);
    CHECK(waited_s <= 8.2);
    last_s = waited_s;
    c.other = 0;
    c.run(0.6);
    supersede_coordinator();
  }
  CHECK(last_s > 7);
  // If no robot begins new versions, earlier failures do not lengthen the wait.
  c.is_fleet_served = false;
  CHECK(c.takeover_s(30) < 2.2);
  c.other = 0;
  c.asking.clear();
  c.is_granting = true;
  c.run(2);
  c.is_fleet_served = true;
  supersede_coordinator();
  c.asking = {2};
  CHECK(c.takeover_s(30) < 0.8);
}

TEST_CASE(
    "a new coordinator that learns a higher epoch raises its own, but yields if it has waited in vain to "
    "grant") {
  Coordinator c;
  REQUIRE(c.takeover_s(5) < 5);
  const Epoch own = c.failover.epoch();
  SECTION("a new coordinator") {
    c.failover.on_obeyed_epoch(own + 1000, false, c.now, 1, EpochHolder::kRobot);
    const Epoch risen = c.failover.epoch();
    CHECK(risen > own + 1000);
    // A rival has begun a higher epoch.
    c.failover.on_obeyed_epoch(risen + 1000, false, c.now, 1, EpochHolder::kRobot);
    CHECK_FALSE(c.failover.is_active());
  }
  SECTION("a coordinator that waited in vain to grant") {
    c.run(0.5);
    c.failover.on_obeyed_epoch(own + 1000, false, c.now, 1, EpochHolder::kRobot);
    CHECK_FALSE(c.failover.is_active());
    CHECK(c.takeover_s(5) < 0.7);
    CHECK(c.failover.epoch() > own + 1000);
  }
}

TEST_CASE("a standby whose clock is set back or forward takes over in time") {
  const double jump_s = GENERATE(-3500.0, -5.0, -0.1, 0.1, 5.0, 3500.0);
  CAPTURE(jump_s);
  Coordinator c;
  c.other = kEpoch;
  c.run(2);
  c.now += from_seconds(jump_s);
  c.run(0.3);
  CHECK_FALSE(c.failover.is_active());
  c.other = 0;
  CHECK(c.takeover_s(2) < 0.3);
}

TEST_CASE("a coordinator whose clock was set back still learns of higher epochs quickly") {
  const Time ahead = kBegin + std::chrono::hours(1);
  Failover failover({0, 5}, false, ahead);
  Epoch learned = failover.epoch();
  for (int i = 0; i < 6; ++i) failover.on_obeyed_epoch(learned += 1000, false, ahead, 7, EpochHolder::kRobot);
  REQUIRE(failover.too_frequent() == 2);
  failover.on_obeyed_epoch(learned += 1000, false, kBegin + std::chrono::seconds(1), 7, EpochHolder::kRobot);
  CHECK(failover.too_frequent() == 2);
}

}  // namespace sidestep::takeover_choice_test
