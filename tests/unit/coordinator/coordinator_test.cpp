// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <limits>

#include "common/messaging/negotiation_codec.hpp"
#include "common/messaging/robot_codec.hpp"
#include "common/messaging/robot_notices.hpp"
#include "tests/catch.hpp"
#include "tests/unit/coordinator/floor.hpp"

namespace sidestep::coordinator_test {

constexpr Epoch kEpoch = 100;
constexpr Time kNow = time_from_ns(1'000'000'000'000);

struct Floor {
  Coordinator coordinator{floor_for_tests(), {1, 2}, kEpoch};
  Version a = rest_version(1, {0, 0}), b = rest_version(2, {1, 0});

  // Messages are decoded as in CoordinatorNode.
  std::optional<Verdict> receive(const msg::Proposal& message) {
    const auto proposal = decode(message, kNow);
    return proposal ? coordinator.on_proposal(*proposal) : std::nullopt;
  }
  std::optional<Verdict> receive(const msg::Registration& message) {
    const auto registration = decode(message, kNow);
    return registration ? coordinator.on_registration(*registration) : std::nullopt;
  }
  void receive(const msg::Feedback& message) {
    if (const auto feedback = decode(message, message.robot(), kNow))
      coordinator.on_feedback(*feedback, feedback->valid_at);
  }
  void register_both() {
    receive(registration_of(a, kEpoch));
    receive(registration_of(b, kEpoch));
    REQUIRE(coordinator.is_granting());
  }
  Verdict ask(const msg::Proposal& proposal) {
    const auto verdict = receive(proposal);
    REQUIRE(verdict);
    return *verdict;
  }
};

std::vector<RobotId> missing(const Coordinator& coordinator) { return missing_robots(coordinator.state()); }

TEST_CASE("nothing is granted until every robot of the roster has registered") {
  Floor floor;
  const auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_NOT_ALL_REGISTERED);
  floor.receive(registration_of(floor.a, kEpoch));
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_NOT_ALL_REGISTERED);
  CHECK(missing(floor.coordinator) == std::vector<RobotId>{2});
  floor.receive(registration_of(floor.b, kEpoch));
  CHECK(floor.ask(proposal).granted_version == 10);
}

TEST_CASE("the first clear candidate is granted, and the verdict gives the reasons for the others") {
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

TEST_CASE("versions must be proposed in increasing order") {
  Floor floor;
  floor.register_both();
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).granted_version == 10);
  CHECK(floor.ask(proposal_of({continued(floor.a, 9, 1, {0, -3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_OLD_VERSION);
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
  CHECK(floor.coordinator.state().invalid() == 1);
}

TEST_CASE("a standby answers no messages, and begins its own epoch with an empty ledger") {
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
  floor.receive(fact(floor.a, 1));
  CHECK(floor.coordinator.ledger().versions(1).empty());
  floor.coordinator.begin_epoch(kEpoch + 5);
  CHECK(missing(floor.coordinator).size() == 2);
  CHECK(floor.ask(proposal).reasons[0] == msg::Reason::REASON_WRONG_EPOCH);
}

TEST_CASE("every registration is answered, and the answer echoes its time stamp") {
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

TEST_CASE("a verdict echoes the time stamp of its proposal, also of a repeated one") {
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
  CHECK(floor.coordinator.state().invalid() == 1);
}

TEST_CASE("a fact from a robot removes the versions that it has left") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3});
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted_version == 10);
  floor.receive(fact(p, 1.5));
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 10);
}

TEST_CASE("hostile proposals get a refusal or no answer, and change nothing") {
  Floor floor;
  floor.register_both();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto good = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  const auto spoil = [&](auto change) {
    auto proposal = good;
    change(proposal);
    return floor.ask(proposal).reasons[0];
  };
  auto malformed = msg::Reason::REASON_MALFORMED;
  CHECK(spoil([&](auto& p) { p.candidates()[0].x_m(nan); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].vy_mps(inf); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phases()[0].ax_mps2(nan); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phases()[1].duration_ns(-1); }) == malformed);
  CHECK(spoil([&](auto& p) {
          p.candidates()[0].phases()[1].duration_ns(std::numeric_limits<std::int64_t>::max());
        }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].phase_count(200); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].start_ns(-5); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].start_ns(std::numeric_limits<std::int64_t>::max()); }) ==
        malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].robot(2); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidates()[0].incarnation(2); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidate_count(0); }) == malformed);
  CHECK(spoil([&](auto& p) { p.candidate_count(255); }) == malformed);
  for (const auto change :
       {+[](msg::Proposal& p) { p.robot(3); }, +[](msg::Proposal& p) { p.robot(4'000'000'000); },
        +[](msg::Proposal& p) { p.header().sender(2); },
        +[](msg::Proposal& p) {
          p.robot(3);
          p.header().sender(3);
        }}) {
    auto proposal = good;
    change(proposal);
    CHECK_FALSE(floor.receive(proposal));
  }
  CHECK(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(2).size() == 1);
}

TEST_CASE("random messages of every kind leave the coordinator consistent") {
  int contradictions = 0;
  const std::uint64_t seed = 7;
  CAPTURE(seed);
  Rng rng(seed);
  Floor floor;
  floor.register_both();
  const auto noise = [&](msg::Version& v) {
    switch (rng.below(8)) {
      case 0:
        v.x_m(rng.normal() * 1e6);
        break;
      case 1:
        v.phase_count(static_cast<std::uint8_t>(rng.bits()));
        break;
      case 2:
        v.start_ns(static_cast<std::int64_t>(rng.bits() >> rng.below(40)));
        break;
      case 3:
        v.phases()[0].duration_ns(static_cast<std::int64_t>(rng.bits()));
        break;
      case 4:
        v.base(rng.bits() >> rng.below(64));
        break;
      case 5:
        v.version_number(rng.bits() >> rng.below(64));
        break;
      case 6:
        v.robot(static_cast<std::uint32_t>(rng.bits() >> rng.below(32)));
        break;
      default:
        v.vx_mps(rng.normal());
        break;
    }
  };
  for (int i = 0; i < 100'000; ++i) {
    auto proposal = proposal_of({continued(floor.a, static_cast<VersionNumber>(i), 1, {0, 3})}, kEpoch);
    noise(proposal.candidates()[0]);
    floor.receive(proposal);
    auto registration = registration_of(floor.b, kEpoch, rng.below(3));
    noise(registration.versions()[0]);
    registration.version_count(static_cast<std::uint8_t>(rng.bits()));
    floor.receive(registration);
    auto feedback = fact(floor.a, 1);
    noise(feedback.executing());
    feedback.valid_at_ns(static_cast<std::int64_t>(rng.bits() >> (16 + rng.below(16))));
    feedback.is_off_reference(rng.chance(0.5));
    floor.receive(feedback);
    const bool is_quarantined = floor.coordinator.ledger().is_quarantined(1);
    contradictions += is_quarantined;
    // An own stop with a very high number would make all later facts stale.
    if (is_quarantined || i % 100 == 0) {
      floor.coordinator.begin_epoch(kEpoch);
      floor.register_both();
    }
    REQUIRE_FALSE(floor.coordinator.ledger().versions(1).empty());
    REQUIRE_FALSE(floor.coordinator.ledger().versions(2).empty());
  }
  CHECK(contradictions > 3000);
  CHECK(floor.coordinator.state().grants() > 3000);
}

TEST_CASE("a robot whose fact contradicts the ledger is quarantined, and the others go on") {
  Floor floor;
  floor.register_both();
  const Version granted = continued(floor.a, 10, 1, {0, 3});
  REQUIRE(floor.ask(proposal_of({granted}, kEpoch)).granted_version == 10);
  Version rounded = granted;  // as by firmware that computes with less precision
  rounded.trajectory = Trajectory(granted.trajectory.start(), {{1e-7, 0}, {0, 0}});
  rounded.trajectory.append(from_seconds(1.0 / 60), {0, 3});
  append_stop(rounded.trajectory, 5);
  floor.receive(fact(rounded, 1.01));
  CHECK(floor.coordinator.ledger().is_quarantined(1));
  CHECK(floor.coordinator.is_granting());
  const auto state = floor.coordinator.state();
  REQUIRE(state.notices().size() == 1);
  CHECK(state.notices()[0].robot() == 1);
  CHECK(state.notices()[0].is_quarantined());
  CHECK_FALSE(state.notices()[0].is_missing());
  // Its versions and the reported one stay, whatever it reports.
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
  floor.receive(fact(floor.a, 1.02));
  floor.receive(fact(granted, 1.5));
  floor.receive(fact(rounded, 1.6));
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
  CHECK(floor.ask(proposal_of({continued(granted, 11, 2, {0, 3})}, kEpoch)).reasons[0] ==
        msg::Reason::REASON_QUARANTINED);
  // A verdict that was given before is repeated.
  CHECK(floor.ask(proposal_of({granted}, kEpoch)).granted_version == 10);
  CHECK(floor.ask(proposal_of({continued(floor.b, 20, 1, {0, 3})}, kEpoch)).granted_version == 20);
}

TEST_CASE("other robots keep clear of what a quarantined robot has reported") {
  Floor floor;
  floor.register_both();
  floor.receive(fact(rest_version(1, {0.5, 0}, 7), 1));
  REQUIRE(floor.coordinator.ledger().is_quarantined(1));
  const auto towards = [&](VersionNumber number) {
    return proposal_of({continued(floor.b, number, 2, {-3, 0}, 0.5)}, kEpoch);
  };
  CHECK(floor.ask(towards(20)).reasons[0] == msg::Reason::REASON_CONFLICT);
  CHECK(floor.ask(towards(21)).blockers[0] == 1);
}

TEST_CASE("a quarantined robot is released by a new agent, a new epoch, or when it is lifted") {
  Floor floor;
  floor.register_both();
  const Version unknown = rest_version(1, {0.5, 0}, 7);
  floor.receive(fact(unknown, 1));
  REQUIRE(floor.coordinator.ledger().is_quarantined(1));
  SECTION("the same agent does not release it") {
    CHECK(floor.receive(registration_of(floor.a, kEpoch))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK(floor.coordinator.ledger().is_quarantined(1));
  }
  SECTION("a new agent lists what the robot may execute") {
    CHECK(floor.receive(registration_of(unknown, kEpoch, 2))->reasons[0] == msg::Reason::REASON_GRANTED);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
    CHECK(floor.coordinator.ledger().versions(1)[0].number == 7);
    floor.receive(fact(unknown, 2));
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
  }
  SECTION("a new epoch begins with registrations") {
    floor.coordinator.begin_epoch(kEpoch + 1);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    CHECK(missing(floor.coordinator).size() == 2);
  }
  SECTION("a lifted robot executes nothing") {
    auto lifted = fact(rest_version(1, {0, 0}), 2);
    lifted.is_lifted(true);
    floor.receive(lifted);
    CHECK_FALSE(floor.coordinator.ledger().is_quarantined(1));
    CHECK(floor.coordinator.ledger().versions(1).empty());
  }
}

TEST_CASE("an operator can attest the absence of a robot that has not registered, until it registers") {
  Floor floor;
  CHECK_FALSE(floor.coordinator.on_attestation(3));  // not on the roster
  floor.receive(registration_of(floor.b, kEpoch));
  CHECK_FALSE(floor.coordinator.on_attestation(2));  // it has registered
  CHECK(floor.coordinator.on_attestation(1));
  CHECK_FALSE(floor.coordinator.on_attestation(1));
  CHECK(floor.coordinator.is_granting());
  CHECK(missing(floor.coordinator).empty());
  CHECK(floor.coordinator.state().absent() == 1);
  const Version crossing = continued(floor.b, 20, 1, {-3, 0}, 0.6);
  CHECK(floor.ask(proposal_of({crossing}, kEpoch)).granted_version == 20);
  // It is on the floor after all.
  CHECK(floor.receive(registration_of(floor.a, kEpoch))->reasons[0] == msg::Reason::REASON_GRANTED);
  CHECK(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().absent() == 0);
  CHECK(floor.coordinator.state().conflicts() == 1);
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).granted_version == 10);
}

TEST_CASE("an attestation is for one epoch, and a robot that is heard of is kept clear of") {
  Floor floor;
  floor.receive(registration_of(floor.b, kEpoch));
  REQUIRE(floor.coordinator.on_attestation(1));
  floor.receive(fact(floor.a, 1));
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

TEST_CASE("the stop of a robot that lost its reference enters the ledger, and its conflicts are reported") {
  Floor floor;
  floor.register_both();
  Version stop = rest_version(1, {0.85, 0}, 1'000'000);
  stop.inflation_m = 0.01;
  auto feedback = fact(stop, 1);
  floor.receive(feedback);
  CHECK(floor.coordinator.ledger().is_quarantined(1));  // the fact does not say that it lost its reference
  floor.coordinator.begin_epoch(kEpoch);
  floor.register_both();
  feedback.is_off_reference(true);
  floor.receive(feedback);
  CHECK(floor.coordinator.is_granting());
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
  const auto state = floor.coordinator.state();
  CHECK(state.conflicts() == 1);
  CHECK(state.conflict_first() == 1);
  CHECK(state.conflict_second() == 2);
  // A version that does not end at rest is refused, also off reference.
  feedback.executing().vx_mps(1);
  feedback.executing().version_number(2'000'000);
  floor.receive(feedback);
  CHECK(floor.coordinator.state().invalid() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
}

TEST_CASE("an absent robot registers without versions and is granted a rest version only") {
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
