// SPDX-License-Identifier: Apache-2.0
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE("nothing is granted until every robot on the roster has registered") {
  Floor floor;
  const auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_NOT_ALL_REGISTERED);
  floor.receive(registration_of(floor.a, kEpoch));
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_NOT_ALL_REGISTERED);
  CHECK(missing(floor.coordinator) == std::vector<RobotId>{2});
  floor.receive(registration_of(floor.b, kEpoch));
  CHECK(floor.ask(proposal).granted_version == 10);
}

TEST_CASE("the first clear candidate is granted, and the verdict gives reasons for the others") {
  Floor floor;
  floor.register_both();
  const auto verdict =
      floor.ask(proposal_of({continued(floor.a, 10, 1, {3, 0}, 0.6), continued(floor.a, 11, 1, {0, 3}),
                             continued(floor.a, 12, 1, {0, -3})},
                            kEpoch));
  CHECK(verdict.granted_version == 11);
  CHECK(verdict.reasons[0] == msg::Reason::REASON_CONFLICT);
  CHECK(verdict.blockers[0] == 2);
  CHECK(verdict.reasons[1] == msg::Reason::REASON_GRANTED);
  CHECK(verdict.reasons[2] == msg::Reason::REASON_NOT_EVALUATED);
}

TEST_CASE("a repeated proposal gets the same verdict again") {
  Floor floor;
  floor.register_both();
  const auto first = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  const auto second = proposal_of({continued(floor.a, 11, 1, {0, -3})}, kEpoch);
  CHECK(floor.ask(first).granted_version == 10);
  CHECK(floor.ask(second).granted_version == 11);
  CHECK(floor.ask(first).granted_version == 10);
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
}

TEST_CASE("versions must be proposed in increasing order of their numbers") {
  Floor floor;
  floor.register_both();
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).granted_version == 10);
  CHECK(floor.ask(proposal_of({continued(floor.a, 9, 1, {0, -3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_OLD_VERSION);
}

TEST_CASE("a denied version is not granted later, even after its verdict has been forgotten") {
  Floor floor;
  floor.register_both();
  // This version would drive through the other robot.
  const auto denied = proposal_of({continued(floor.a, 10, 1, {3, 0}, 0.6)}, kEpoch);
  REQUIRE(floor.ask(denied).reasons[0] == msg::Reason::REASON_CONFLICT);
  for (VersionNumber number = 1; number <= 9; ++number)  // older versions; their verdicts are not remembered
    CHECK(floor.ask(proposal_of({continued(floor.a, number, 1, {0, 3})}, kEpoch)).granted_version == 0);
  for (VersionNumber number = 11; number <= 20; ++number)
    CHECK(floor.ask(proposal_of({continued(floor.a, number, 1, {3, 0}, 0.6)}, kEpoch)).granted_version == 0);
  // The other robot is lifted, so the path is free.
  auto lifted = make_report(rest_version(2, {1, 0}), 2);
  lifted.is_lifted(true);
  floor.receive(lifted);
  const Verdict late = floor.ask(denied);
  CHECK(late.granted_version == 0);
  CHECK(late.reasons[0] == msg::Reason::REASON_OLD_VERSION);
  CHECK(floor.ask(proposal_of({continued(floor.a, 21, 3, {3, 0}, 0.6)}, kEpoch)).granted_version == 21);
}

TEST_CASE("proposals for another epoch or from an older agent are refused") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3});
  CHECK(floor.ask(proposal_of({p}, kEpoch - 1)).reasons[0] == msg::Reason::REASON_WRONG_EPOCH);
  CHECK(floor.ask(proposal_of({p}, kEpoch, 0)).reasons[0] == msg::Reason::REASON_OLD_INCARNATION);
  // A new agent must register before it may propose.
  Version q = p;
  q.incarnation = 2;
  CHECK(floor.ask(proposal_of({q}, kEpoch, 2)).reasons[0] == msg::Reason::REASON_NOT_ALL_REGISTERED);
  floor.receive(registration_of(floor.a, kEpoch, 2));
  CHECK(floor.ask(proposal_of({p}, kEpoch, 1)).reasons[0] == msg::Reason::REASON_OLD_INCARNATION);
  CHECK(floor.ask(proposal_of({q}, kEpoch, 2)).granted_version == 10);
}

TEST_CASE("a new agent's registration cannot add versions that were never granted") {
  Floor floor;
  floor.register_both();
  floor.receive(registration_of(rest_version(1, {0.9, 0}, 77), kEpoch, 2));
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 0);
  CHECK(floor.coordinator.drops().total(DropReason::kMalformedRegistration) == 1);
}

TEST_CASE("a standby answers no messages and begins its own epoch with an empty ledger") {
  Floor floor;
  floor.register_both();
  floor.coordinator.begin_epoch(0);
  CHECK_FALSE(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().coordinator_mode() == msg::CoordinatorMode::COORDINATOR_STANDBY);
  CHECK(floor.coordinator.state().epoch() == 0);
  CHECK(missing(floor.coordinator).empty());
  const auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  CHECK_FALSE(floor.receive(proposal));
  CHECK_FALSE(floor.receive(proposal_of({continued(floor.a, 10, 1, {0, 3})}, 0)));
  CHECK_FALSE(floor.receive(registration_of(floor.a, 0)));
  floor.receive(make_report(floor.a, 1));
  CHECK(floor.coordinator.ledger().versions(1).empty());
  floor.coordinator.begin_epoch(kEpoch + 5);
  CHECK(missing(floor.coordinator).size() == 2);
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_WRONG_EPOCH);
}

TEST_CASE("every registration is answered, and the answer echoes its timestamp") {
  Floor floor;
  const auto answer = [&](msg::Registration registration) {
    registration.header().stamp_ns(4711);
    const auto verdict = floor.receive(registration);
    REQUIRE(verdict);
    CHECK(verdict->robot == registration.robot());
    CHECK(verdict->epoch == kEpoch);
    CHECK(verdict->proposal_number == 0);
    CHECK(verdict->granted_version == 0);
    CHECK(verdict->request_sent_at == time_from_ns(4711));
    return verdict->reasons[0];
  };
  CHECK(answer(registration_of(floor.a, kEpoch + 50)) == msg::Reason::REASON_WRONG_EPOCH);
  CHECK(answer(registration_of(floor.a, kEpoch - 50)) == msg::Reason::REASON_WRONG_EPOCH);
  CHECK(missing(floor.coordinator).size() == 2);
  CHECK(answer(registration_of(floor.a, kEpoch, 2)) == msg::Reason::REASON_GRANTED);
  CHECK(answer(registration_of(floor.a, kEpoch, 2)) == msg::Reason::REASON_GRANTED);
  CHECK(answer(registration_of(floor.a, kEpoch, 1)) == msg::Reason::REASON_OLD_INCARNATION);
  auto malformed = registration_of(floor.b, kEpoch);
  malformed.version_count(0);
  CHECK(answer(malformed) == msg::Reason::REASON_MALFORMED);
  CHECK_FALSE(floor.receive(registration_of(rest_version(3, {0, 0}), kEpoch)));
  malformed.header().sender(1);
  CHECK_FALSE(floor.receive(malformed));
  CHECK(missing(floor.coordinator) == std::vector<RobotId>{2});
}

TEST_CASE("a verdict echoes the timestamp of its proposal, even if the proposal is a repetition") {
  Floor floor;
  floor.register_both();
  auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  proposal.header().stamp_ns(100);
  CHECK(floor.ask(proposal).request_sent_at == time_from_ns(100));
  proposal.header().stamp_ns(200);
  CHECK(floor.ask(proposal).request_sent_at == time_from_ns(200));
  CHECK(floor.ask(proposal).granted_version == 10);
  proposal.epoch(kEpoch - 1);
  CHECK(floor.ask(proposal).request_sent_at == time_from_ns(200));
}

TEST_CASE("a registration that lists a version twice is refused") {
  Floor floor;
  auto registration = registration_of(floor.a, kEpoch);
  registration.version_count(2);
  registration.versions()[1] = encode(rest_version(1, {1, 1}));
  floor.receive(registration);
  CHECK(missing(floor.coordinator).size() == 2);
  CHECK(floor.coordinator.drops().total(DropReason::kMalformedRegistration) == 1);
}

TEST_CASE("a fact from a robot removes the versions that the robot has left") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3});
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(make_report(p, 1.5));
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 10);
}

}  // namespace sidestep::coordinator_test
