// SPDX-License-Identifier: Apache-2.0
// Robots that are silent or that vision sees away from their versions.
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE(
    "a robot that should move counts as silent from 50 ms after its last fact until its versions have "
    "ended") {
  Floor floor;
  floor.register_both();
  const auto silent_at = [&](double at) {
    const RobotObservation observation{1, at_s(at), {0, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(at));
    const auto state = floor.coordinator.state();
    return state.notices().size() == 1 && state.notices()[0].robot() == 1 && state.notices()[0].is_silent();
  };
  CHECK_FALSE(silent_at(0.9));  // at rest
  const Version p = continued(floor.a, 10, 1, {0, 3}, 0.3);
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(make_report(p, 1.01));
  CHECK_FALSE(silent_at(1.05));
  CHECK(silent_at(1.07));
  // After a gap of 60 ms, the robot may be silent for 120 ms.
  floor.receive(make_report(p, 1.07));
  CHECK_FALSE(silent_at(1.18));
  CHECK(silent_at(1.2));
  CHECK_FALSE(silent_at(to_seconds(p.trajectory.end().time_since_epoch()) + 0.01));
}

TEST_CASE("a robot that reports facts rarely counts as silent after three missing facts") {
  const Version a = rest_version(1, {0, 0});
  for (const double period_s : {1.0 / 60, 0.1, 0.2}) {
    CAPTURE(period_s);
    Coordinator coordinator(floor_for_tests(), {1}, kEpoch, Duration{1'000'000}, from_seconds(period_s));
    const auto registration = decode(registration_of(a, kEpoch), kNow);
    REQUIRE(coordinator.on_registration(*registration));
    const Version p = continued(a, 10, 1, {0, 3}, 0.6);
    REQUIRE(coordinator.on_proposal(*decode(proposal_of({p}, kEpoch), kNow))->granted_version == 10);
    coordinator.on_robot_report(*decode(make_report(p, 1.01), 1, kNow), at_s(1.01));
    const double limit_s = std::max(0.05, 3 * period_s);
    const auto is_silent_at = [&](double at) {
      coordinator.on_world_state({}, at_s(at));
      return coordinator.is_silent(1);
    };
    REQUIRE(at_s(1.01 + 1.01 * limit_s) < p.trajectory.end());
    CHECK_FALSE(is_silent_at(1.01 + 0.99 * limit_s));
    CHECK(is_silent_at(1.01 + 1.01 * limit_s));
  }
}

TEST_CASE("a robot whose clock jumped ahead counts as silent until its own stop starts") {
  Floor floor;
  floor.register_both();
  const auto is_silent_at = [&](double at) {
    const RobotObservation observation{1, at_s(at), {0, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(at));
    return floor.coordinator.is_silent(1);
  };
  const double ahead_s = GENERATE(0.04, 0.06, 4.0);
  CAPTURE(ahead_s);
  CHECK_FALSE(is_silent_at(1));
  Version stop = rest_version(1, {0, 0}, 1'000'000);
  stop.trajectory = Trajectory::resting(at_s(1 + ahead_s), {0, 0});
  auto message = make_report(stop, 1 + ahead_s);
  message.is_off_reference(true);
  const auto robot_report = decode(message, 1, at_s(1));
  REQUIRE(robot_report);
  floor.coordinator.on_robot_report(*robot_report, at_s(1));
  CHECK(is_silent_at(1.001) == (ahead_s > 0.055));
  CHECK_FALSE(is_silent_at(1.01 + ahead_s));
}

TEST_CASE("a robot with a slow clock counts as silent until its version has ended by that clock") {
  const Duration max_difference{100'000'000};
  Floor floor;
  floor.coordinator = Coordinator(floor_for_tests(), {1, 2}, kEpoch, max_difference);
  floor.register_both();
  const auto is_silent_at = [&](double at) {
    const RobotObservation observation{1, at_s(at), {0, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(at));
    return floor.coordinator.is_silent(1);
  };
  const Version p = continued(floor.a, 10, 1, {0, 3}, 0.3);
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(make_report(p, 1.01));
  const double end_s = to_seconds(p.trajectory.end().time_since_epoch());
  CHECK(is_silent_at(end_s + 0.09));
  CHECK_FALSE(is_silent_at(end_s + 0.11));
  // A robot whose clock is ahead within the bound does not count as silent.
  Version stop = rest_version(2, {1, 0}, 1'000'000);
  stop.trajectory = Trajectory::resting(at_s(3.14), {1, 0});
  auto message = make_report(stop, 3.14);
  message.is_off_reference(true);
  floor.receive(message);
  CHECK_FALSE(floor.coordinator.is_silent(2));
  (void)is_silent_at(3);
  CHECK_FALSE(floor.coordinator.is_silent(2));
  (void)is_silent_at(2.98);
  CHECK(floor.coordinator.is_silent(2));
}

TEST_CASE("dropped or uncompared observations do not count as watching") {
  Floor floor;
  floor.register_both();
  const auto see = [&](std::vector<RobotObservation> robots, double now, bool is_whole = true) {
    floor.coordinator.on_world_state(robots, at_s(now), is_whole);
  };
  const auto seen = [](RobotId robot, double at) {
    return RobotObservation{robot, at_s(at), {robot - 1.0, 0}, Vec2(0, 0), 1e-6};
  };
  const auto watched_until = [&] { return time_from_ns(floor.coordinator.state().watched_until_ns()); };
  see({seen(1, 1), seen(2, 1.01)}, 1.02);
  REQUIRE(watched_until() == at_s(1.01));
  SECTION("an observation from the future") {
    see({seen(1, 1.1), seen(2, 1.2)}, 1.11);
    CHECK(watched_until() == at_s(1.01));
    CHECK(floor.coordinator.drops().total(DropReason::kFutureObservation) == 1);
  }
  SECTION("a world state from which the caller dropped an observation") {
    see({seen(1, 1.1)}, 1.11, false);
    CHECK(watched_until() == at_s(1.01));
  }
  SECTION("a world state without robots, and one without a new observation") {
    see({}, 1.5);
    see({seen(1, 1), seen(2, 1.01)}, 1.6);
    CHECK(watched_until() == at_s(1.01));
  }
  SECTION("an observation from before all versions that the ledger remembers") {
    Version stop = rest_version(2, {1, 0}, 1'000'000);
    stop.trajectory = Trajectory::resting(at_s(1.2), {1, 0});
    REQUIRE(floor.coordinator.is_granting());
    floor.coordinator.begin_epoch(kEpoch);
    floor.receive(registration_of(floor.a, kEpoch));
    floor.receive(registration_of(stop, kEpoch));
    see({seen(1, 1.1), seen(2, 1.1)}, 1.19);
    CHECK(watched_until() == Time{});
    see({seen(1, 1.21), seen(2, 1.21)}, 1.22);
    CHECK(watched_until() == at_s(1.21));
  }
  SECTION("observations slightly ahead of the clock count up to the present") {
    see({seen(1, 1.1005), seen(2, 1.1005)}, 1.1);
    CHECK(watched_until() == at_s(1.1));
  }
  SECTION("robots that are not on the roster do not matter") {
    see({seen(1, 1.1), seen(7, 99)}, 1.11);
    CHECK(watched_until() == at_s(1.1));
  }
}

TEST_CASE("an observation that is ahead by more than the clock bound counts as being from the future") {
  const double bound_s = GENERATE(0.0005, 0.05, 0.2);
  CAPTURE(bound_s);
  Floor floor;
  floor.coordinator = Coordinator(floor_for_tests(), {1, 2}, kEpoch, from_seconds(2 * bound_s));
  floor.register_both();
  const auto observe_early = [&](double ahead_s) {
    const RobotObservation observation{1, at_s(1 + ahead_s), {0.3, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(1));
  };
  observe_early(2 * bound_s + 0.0001);
  CHECK_FALSE(floor.coordinator.displaced().contains(1));
  CHECK(floor.coordinator.state().watched_until_ns() == 0);
  observe_early(2 * bound_s - 0.0001);
  CHECK(floor.coordinator.displaced().contains(1));
  CHECK(floor.coordinator.state().watched_until_ns() == to_ns(at_s(1)));
}

TEST_CASE("a robot that vision sees away from its versions is granted nothing, and a notice names it") {
  Floor floor;
  floor.register_both();
  const auto see = [&](RobotId robot, Vec2 position, double at) {
    const RobotObservation observation{robot, at_s(at), position, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(at));
  };
  see(1, {0.005, 0}, 1);
  CHECK_FALSE(floor.coordinator.displaced().any());
  see(1, {0.05, 0}, 1.1);
  REQUIRE(floor.coordinator.displaced().contains(1));
  const auto state = floor.coordinator.state();
  CHECK(state.watched_until_ns() == to_ns(at_s(1.1)));
  REQUIRE(state.notices().size() == 1);
  CHECK(state.notices()[0].robot() == 1);
  CHECK(state.notices()[0].is_displaced());
  CHECK(state.notices()[0].x_m() == 0.05);
  CHECK(state.notices()[0].observed_at_ns() == to_ns(at_s(1.1)));
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 2, {0, 3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_DISPLACED);
  CHECK(floor.ask(proposal_of({continued(floor.b, 20, 2, {0, 3})}, kEpoch)).granted_version == 20);
  for (const double at : {1.2, 1.3, 1.4}) see(1, {0, 0}, at);
  CHECK_FALSE(floor.coordinator.displaced().any());
  CHECK(floor.ask(proposal_of({continued(floor.a, 11, 2, {0, 3})}, kEpoch)).granted_version == 11);
}

TEST_CASE("a coordinator that begins an epoch or stands by names no robot as silent") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3}, 0.3);
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(make_report(p, 1.01));
  const RobotObservation observation{1, at_s(1.07), {0, 0}, Vec2(0, 0), 1e-6};
  floor.coordinator.on_world_state({&observation, 1}, at_s(1.07));
  REQUIRE(floor.coordinator.has_uncontrolled_robots());
  floor.coordinator.begin_epoch(GENERATE(Epoch{0}, kEpoch + 1));
  CHECK_FALSE(floor.coordinator.has_uncontrolled_robots());
}

TEST_CASE("a coordinator whose clock was set back uses new observations again") {
  Floor floor;
  floor.register_both();
  const auto see = [&](double x, double at) {
    const RobotObservation observation{1, at_s(at), {x, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world_state({&observation, 1}, at_s(at));
    return floor.coordinator.displaced().contains(1);
  };
  // The coordinator's clock and the cameras' clocks were an hour ahead.
  CHECK_FALSE(see(0, 3600));
  floor.coordinator.forget_times();
  CHECK(floor.coordinator.state().watched_until_ns() == 0);
  CHECK(see(0.3, 10));
  CHECK(floor.coordinator.state().watched_until_ns() == to_ns(at_s(10)));
}

}  // namespace sidestep::coordinator_test
