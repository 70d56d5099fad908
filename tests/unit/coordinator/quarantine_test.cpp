// SPDX-License-Identifier: Apache-2.0
// Robots whose facts contradict the ledger or report own stops.
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE("a robot whose fact contradicts the ledger is quarantined, and other robots continue") {
  Floor floor;
  floor.register_both();
  const Version granted = continued(floor.a, 10, 1, {0, 3});
  REQUIRE(floor.ask(proposal_of({granted}, kEpoch)).granted_version == 10);
  Version rounded = granted;  // as reported by firmware with less precision
  rounded.trajectory = Trajectory(granted.trajectory.start(), {{1e-7, 0}, {0, 0}});
  rounded.trajectory.append(from_seconds(1.0 / 60), {0, 3});
  append_stop(rounded.trajectory, 5);
  floor.receive(make_report(rounded, 1.01));
  CHECK(floor.coordinator.ledger().is_quarantined(1));
  CHECK(floor.coordinator.is_granting());
  const auto state = floor.coordinator.state();
  REQUIRE(state.notices().size() == 1);
  CHECK(state.notices()[0].robot() == 1);
  CHECK(state.notices()[0].is_quarantined());
  CHECK_FALSE(state.notices()[0].is_missing());
  // The robot's versions and the reported version remain in the ledger after further reports.
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
  floor.receive(make_report(floor.a, 1.02));
  floor.receive(make_report(granted, 1.5));
  floor.receive(make_report(rounded, 1.6));
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
  CHECK(floor.ask(proposal_of({continued(granted, 11, 2, {0, 3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_QUARANTINED);
  // An earlier verdict is repeated.
  CHECK(floor.ask(proposal_of({granted}, kEpoch)).granted_version == 10);
  CHECK(floor.ask(proposal_of({continued(floor.b, 20, 1, {0, 3})}, kEpoch)).granted_version == 20);
}

TEST_CASE("a robot that obeys a higher epoch is not quarantined for executing a version of that epoch") {
  Floor floor;
  floor.register_both();
  auto granted_elsewhere = make_report(rest_version(1, {0.5, 0}, 7), 1);
  granted_elsewhere.obeyed_epoch(kEpoch + 1);
  floor.receive(granted_elsewhere);
  CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
  CHECK(floor.coordinator.ledger().versions(1).size() == 1);
  SECTION("the robot's own stop still enters the ledger") {
    auto stop = make_report(rest_version(1, {0.5, 0}, 1'000'000), 1.1);
    stop.obeyed_epoch(kEpoch + 1);
    stop.is_off_reference(true);
    floor.receive(stop);
    REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
    CHECK(floor.coordinator.ledger().versions(1).front().number == 1'000'000);
  }
  SECTION("a fact under the coordinator's own epoch contradicts the ledger") {
    granted_elsewhere.obeyed_epoch(kEpoch);
    floor.receive(granted_elsewhere);
    CHECK(floor.coordinator.ledger().is_quarantined(1));
  }
}

TEST_CASE("other robots keep clear of the version that a quarantined robot has reported") {
  Floor floor;
  floor.register_both();
  floor.receive(make_report(rest_version(1, {0.5, 0}, 7), 1));
  REQUIRE(floor.coordinator.ledger().is_quarantined(1));
  const auto towards = [&](VersionNumber number) {
    return proposal_of({continued(floor.b, number, 2, {-3, 0}, 0.5)}, kEpoch);
  };
  CHECK(floor.ask(towards(20)).reasons[0] == msg::Reason::REASON_CONFLICT);
  CHECK(floor.ask(towards(21)).blockers[0] == 1);
}

TEST_CASE("a quarantined robot is released by a new agent, a new epoch or a lifting") {
  Floor floor;
  floor.register_both();
  const Version unknown = rest_version(1, {0.5, 0}, 7);
  floor.receive(make_report(unknown, 1));
  REQUIRE(floor.coordinator.ledger().is_quarantined(1));
  SECTION("a registration by the same agent does not release the robot") {
    CHECK(floor.receive(registration_of(floor.a, kEpoch))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK(floor.coordinator.ledger().is_quarantined(1));
  }
  SECTION("a registration by a new agent releases the robot") {
    CHECK(floor.receive(registration_of(unknown, kEpoch, 2))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
    CHECK(floor.coordinator.ledger().versions(1)[0].number == 7);
    floor.receive(make_report(unknown, 2));
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
  }
  SECTION("a new epoch releases the robot, which must register again") {
    floor.coordinator.begin_epoch(kEpoch + 1);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    CHECK(missing(floor.coordinator).size() == 2);
  }
  SECTION("a lifting releases the robot and removes its versions") {
    auto lifted = make_report(rest_version(1, {0, 0}), 2);
    lifted.is_lifted(true);
    floor.receive(lifted);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    CHECK(floor.coordinator.ledger().versions(1).empty());
  }
}

TEST_CASE("a registration sent before the robot left its versions does not end the quarantine") {
  Floor floor;
  floor.register_both();
  const auto late = registration_of(floor.a, kEpoch, 2);
  const Version unknown = rest_version(1, {0.5, 0}, 7);
  auto under_new_agent = make_report(unknown, 1);
  under_new_agent.obeyed_incarnation(2);
  floor.receive(under_new_agent);
  REQUIRE(floor.coordinator.ledger().is_quarantined(1));
  CHECK(floor.receive(late)->reasons[0] == msg::Reason::REASON_QUARANTINED);
  CHECK(floor.coordinator.ledger().is_quarantined(1));
  const Version towards = continued(floor.b, 20, 2, {-3, 0}, 0.5);
  CHECK(floor.ask(proposal_of({towards}, kEpoch)).reasons[0] == msg::Reason::REASON_CONFLICT);
  SECTION("a registration with different content under the same number does not end the quarantine") {
    CHECK(floor.receive(registration_of(rest_version(1, {0, 0}, 7), kEpoch, 2))->reasons[0] ==
          msg::Reason::REASON_QUARANTINED);
    CHECK(floor.coordinator.ledger().is_quarantined(1));
  }
  SECTION("a registration of the reported version ends the quarantine") {
    CHECK(floor.receive(registration_of(unknown, kEpoch, 2))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    CHECK(floor.coordinator.ledger().versions(1).front().number == 7);
  }
  SECTION("a later agent's registration ends the quarantine") {
    CHECK(floor.receive(registration_of(floor.a, kEpoch, 3))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
  }
}

TEST_CASE(
    "the own stop of a robot that lost its reference enters the ledger, and its conflicts are reported") {
  Floor floor;
  floor.register_both();
  Version stop = rest_version(1, {0.85, 0}, 1'000'000);
  stop.inflation_m = 0.01;
  auto robot_report = make_report(stop, 1);
  floor.receive(robot_report);
  CHECK(floor.coordinator.ledger().is_quarantined(
      1));  // the fact does not say that the robot lost its reference
  floor.coordinator.begin_epoch(kEpoch);
  floor.register_both();
  robot_report.is_off_reference(true);
  floor.receive(robot_report);
  CHECK(floor.coordinator.is_granting());
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
  const auto state = floor.coordinator.state();
  CHECK(state.conflicts() == 1);
  CHECK(state.conflict_first() == 1);
  CHECK(state.conflict_second() == 2);
  // A version that does not end at rest is refused, even as an own stop.
  robot_report.executing().vx_mps(1);
  robot_report.executing().version_number(2'000'000);
  floor.receive(robot_report);
  CHECK(floor.coordinator.drops().total(DropReason::kMalformedFeedback) == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
}

}  // namespace sidestep::coordinator_test
