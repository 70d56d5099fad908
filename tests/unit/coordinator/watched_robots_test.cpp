// SPDX-License-Identifier: Apache-2.0
// Robots that are silent, or that vision sees away from their versions.
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE("a robot that should move is silent 50 ms after its last fact, until its versions have ended") {
  Floor floor;
  floor.register_both();
  const auto silent_at = [&](double at) {
    const RobotObservation observation{1, at_s(at), {0, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world({&observation, 1}, at_s(at), at_s(at));
    const auto state = floor.coordinator.state();
    return state.notices().size() == 1 && state.notices()[0].robot() == 1 && state.notices()[0].is_silent();
  };
  CHECK_FALSE(silent_at(0.9));  // at rest
  const Version p = continued(floor.a, 10, 1, {0, 3}, 0.3);
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(fact(p, 1.01));
  CHECK_FALSE(silent_at(1.05));
  CHECK(silent_at(1.07));
  // After a gap of 60 ms it may be silent for 120 ms.
  floor.receive(fact(p, 1.07));
  CHECK_FALSE(silent_at(1.18));
  CHECK(silent_at(1.2));
  CHECK_FALSE(silent_at(to_seconds(p.trajectory.end().time_since_epoch()) + 0.01));
}

TEST_CASE("a robot whose own stop is dated by a clock that has jumped ahead counts as silent until then") {
  Floor floor;
  floor.register_both();
  const auto is_silent_at = [&](double at) {
    const RobotObservation observation{1, at_s(at), {0, 0}, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world({&observation, 1}, at_s(at), at_s(at));
    return floor.coordinator.is_silent(1);
  };
  const double ahead_s = GENERATE(0.04, 0.06, 4.0);
  CAPTURE(ahead_s);
  CHECK_FALSE(is_silent_at(1));
  Version stop = rest_version(1, {0, 0}, 1'000'000);
  stop.trajectory = Trajectory::resting(at_s(1 + ahead_s), {0, 0});
  auto message = fact(stop, 1 + ahead_s);
  message.is_off_reference(true);
  const auto feedback = decode(message, 1, at_s(1));
  REQUIRE(feedback);
  floor.coordinator.on_feedback(*feedback, at_s(1));
  CHECK(is_silent_at(1.001) == (ahead_s > 0.055));
  CHECK_FALSE(is_silent_at(1.01 + ahead_s));
}

TEST_CASE("nothing is granted to a robot that vision sees away from its versions, and it is named") {
  Floor floor;
  floor.register_both();
  const auto see = [&](RobotId robot, Vec2 position, double at) {
    const RobotObservation observation{robot, at_s(at), position, Vec2(0, 0), 1e-6};
    floor.coordinator.on_world({&observation, 1}, at_s(at), at_s(at));
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

}  // namespace sidestep::coordinator_test
