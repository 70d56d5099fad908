// SPDX-License-Identifier: Apache-2.0
// Robots that are absent from the floor according to their own reports or an operator.
#include "tests/catch.hpp"
#include "tests/unit/coordinator/coordinator_fixture.hpp"

namespace sidestep::coordinator_test {

TEST_CASE("an operator can attest that a robot is absent until the robot registers") {
  Floor floor;
  CHECK_FALSE(floor.coordinator.on_attestation(3));  // not on the roster
  floor.receive(registration_of(floor.b, kEpoch));
  CHECK_FALSE(floor.coordinator.on_attestation(2));  // robot 2 has registered
  CHECK(floor.coordinator.on_attestation(1));
  CHECK_FALSE(floor.coordinator.on_attestation(1));
  CHECK(floor.coordinator.is_granting());
  CHECK(missing(floor.coordinator).empty());
  CHECK(floor.coordinator.state().absent() == 1);
  const Version crossing = continued(floor.b, 20, 1, {-3, 0}, 0.6);
  CHECK(floor.ask(proposal_of({crossing}, kEpoch)).granted_version == 20);
  // Robot 1 is on the floor after all.
  CHECK(floor.receive(registration_of(floor.a, kEpoch))->reasons[0] == msg::Reason::REASON_GRANTED);
  CHECK(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().absent() == 0);
  CHECK(floor.coordinator.state().conflicts() == 1);
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).granted_version == 10);
}

TEST_CASE(
    "an attestation is valid for one epoch, and a robot that reports despite its attestation is "
    "quarantined") {
  Floor floor;
  floor.receive(registration_of(floor.b, kEpoch));
  REQUIRE(floor.coordinator.on_attestation(1));
  floor.receive(make_report(floor.a, 1));
  CHECK(floor.coordinator.ledger().is_quarantined(1));
  CHECK(floor.coordinator.ledger().versions(1).size() == 1);
  floor.receive(registration_of(floor.a, kEpoch));
  CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
  floor.coordinator.begin_epoch(kEpoch + 1);
  CHECK(missing(floor.coordinator).size() == 2);
  REQUIRE(floor.coordinator.on_attestation(1));
  floor.coordinator.begin_epoch(kEpoch + 2);
  CHECK(missing(floor.coordinator).size() == 2);
}

TEST_CASE("a held robot in motion is granted nothing, even if it may execute several versions") {
  Floor floor;
  floor.register_both();
  Version last = floor.a;
  VersionNumber number = 10;
  for (std::size_t versions = 2; versions <= 4; ++versions) {
    // The agent does not cooperate: it proposes although its robot is held.
    const Version next = continued(last, number, 1 + 0.01 * static_cast<double>(versions), {0, 3});
    floor.coordinator.set_held(1, true);
    const Verdict refused = floor.ask(proposal_of({next}, kEpoch));
    CHECK(refused.granted_version == 0);
    CHECK(refused.reasons[0] == msg::Reason::REASON_HELD);
    CHECK(floor.coordinator.ledger().versions(1).size() == versions - 1);
    floor.coordinator.set_held(1, false);
    REQUIRE(floor.ask(proposal_of({next}, kEpoch)).granted_version == number);
    REQUIRE(floor.coordinator.ledger().versions(1).size() == versions);
    last = next;
    ++number;
  }
}

TEST_CASE("a held robot is granted nothing in any epoch until it is released") {
  Floor floor;
  floor.coordinator.set_held(1, true);
  for (const Epoch epoch : {kEpoch, kEpoch + 1}) {
    if (epoch > kEpoch) floor.coordinator.begin_epoch(epoch);
    floor.receive(registration_of(floor.a, epoch));
    floor.receive(registration_of(floor.b, epoch));
    REQUIRE(floor.coordinator.is_granting());
    CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, epoch)).reasons[0] ==
          msg::Reason::REASON_HELD);
  }
  CHECK(floor.ask(proposal_of({continued(floor.b, 20, 1, {0, 3})}, kEpoch + 1)).granted_version == 20);
  floor.coordinator.set_held(1, false);
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch + 1)).granted_version == 10);
}

TEST_CASE("an absent robot registers without versions and is granted only a rest version") {
  Floor floor;
  auto absent = registration_of(floor.a, kEpoch);
  absent.is_absent(true);
  CHECK(floor.receive(absent)->reasons[0] == msg::Reason::REASON_MALFORMED);
  absent.version_count(0);
  CHECK(floor.receive(absent)->reasons[0] == msg::Reason::REASON_GRANTED);
  floor.receive(registration_of(floor.b, kEpoch));
  REQUIRE(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().absent() == 1);
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_ABSENT);
  Version blocked = rest_version(1, {0.85, 0}, 11), free = rest_version(1, {0.5, 0.5}, 12);
  blocked.incarnation = free.incarnation = 1;
  const auto verdict = floor.ask(proposal_of({blocked, free}, kEpoch));
  CHECK(verdict.reasons[0] == msg::Reason::REASON_CONFLICT);
  CHECK(verdict.granted_version == 12);
  CHECK(floor.coordinator.state().absent() == 0);
}

}  // namespace sidestep::coordinator_test
