// SPDX-License-Identifier: Apache-2.0
#include "coordinator/coordinator.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/unit/coordinator/floor.hpp"

using namespace sidestep;

namespace {

constexpr Epoch kEpoch = 100;

struct Floor {
  Coordinator coordinator{floor_for_tests(), {1, 2}, kEpoch};
  Version a = standing(1, {0, 0}), b = standing(2, {1, 0});

  void register_both() {
    coordinator.on_registration(registration_of(a, kEpoch));
    coordinator.on_registration(registration_of(b, kEpoch));
    REQUIRE(coordinator.is_granting());
  }
  msg::Verdict ask(const msg::Proposal& proposal) {
    const auto verdict = coordinator.on_proposal(proposal);
    REQUIRE(verdict);
    return *verdict;
  }
};

}  // namespace

TEST_CASE("nothing is granted until every robot of the roster has registered") {
  Floor floor;
  const auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  CHECK(floor.ask(proposal).reasons()[0] == msg::REASON_NOT_ALL_REGISTERED);
  floor.coordinator.on_registration(registration_of(floor.a, kEpoch));
  CHECK(floor.ask(proposal).reasons()[0] == msg::REASON_NOT_ALL_REGISTERED);
  CHECK(floor.coordinator.state().missing() == std::vector<std::uint32_t>{2});
  floor.coordinator.on_registration(registration_of(floor.b, kEpoch));
  CHECK(floor.ask(proposal).granted() == 10);
}

TEST_CASE("the first clear candidate is granted and the reasons of the others are given") {
  Floor floor;
  floor.register_both();
  const auto verdict =
      floor.ask(proposal_of({continued(floor.a, 10, 1, {3, 0}, 0.6), continued(floor.a, 11, 1, {0, 3}),
                             continued(floor.a, 12, 1, {0, -3})},
                            kEpoch));
  CHECK(verdict.granted() == 11);
  CHECK(verdict.reasons()[0] == msg::REASON_CONFLICT);
  CHECK(verdict.blockers()[0] == 2);
  CHECK(verdict.reasons()[1] == msg::REASON_GRANTED);
  CHECK(verdict.reasons()[2] == msg::REASON_NOT_TRIED);
}

TEST_CASE("a repeated proposal is answered with the verdict that it got") {
  Floor floor;
  floor.register_both();
  const auto first = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  const auto second = proposal_of({continued(floor.a, 11, 1, {0, -3})}, kEpoch);
  CHECK(floor.ask(first).granted() == 10);
  CHECK(floor.ask(second).granted() == 11);
  CHECK(floor.ask(first).granted() == 10);
  CHECK(floor.coordinator.ledger().versions(1).size() == 3);
}

TEST_CASE("versions have to be proposed in increasing order") {
  Floor floor;
  floor.register_both();
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).granted() == 10);
  CHECK(floor.ask(proposal_of({continued(floor.a, 9, 1, {0, -3})}, kEpoch)).reasons()[0] ==
        msg::REASON_OLD_VERSION);
}

TEST_CASE("another epoch's proposal and an older agent's are refused") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3});
  CHECK(floor.ask(proposal_of({p}, kEpoch - 1)).reasons()[0] == msg::REASON_WRONG_EPOCH);
  CHECK(floor.ask(proposal_of({p}, kEpoch, 0)).reasons()[0] == msg::REASON_OLD_INCARNATION);
  // A new agent has to register before it is heard.
  Version q = p;
  q.incarnation = 2;
  CHECK(floor.ask(proposal_of({q}, kEpoch, 2)).reasons()[0] == msg::REASON_NOT_ALL_REGISTERED);
  floor.coordinator.on_registration(registration_of(floor.a, kEpoch, 2));
  CHECK(floor.ask(proposal_of({p}, kEpoch, 1)).reasons()[0] == msg::REASON_OLD_INCARNATION);
  CHECK(floor.ask(proposal_of({q}, kEpoch, 2)).granted() == 10);
}

TEST_CASE("a new agent's registration cannot bring in versions that were never granted") {
  Floor floor;
  floor.register_both();
  floor.coordinator.on_registration(registration_of(standing(1, {0.9, 0}, 77), kEpoch, 2));
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 0);
  CHECK(floor.coordinator.state().invalid() == 1);
}

TEST_CASE("a coordinator that stands by answers nobody, and begins with nothing in an epoch of its own") {
  Floor floor;
  floor.register_both();
  floor.coordinator.begin_epoch(0);
  CHECK_FALSE(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().coordinator_mode() == msg::COORDINATOR_STANDBY);
  CHECK(floor.coordinator.state().epoch() == 0);
  CHECK(floor.coordinator.state().missing().empty());
  const auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  CHECK_FALSE(floor.coordinator.on_proposal(proposal));
  CHECK_FALSE(floor.coordinator.on_proposal(proposal_of({continued(floor.a, 10, 1, {0, 3})}, 0)));
  CHECK_FALSE(floor.coordinator.on_registration(registration_of(floor.a, 0)));
  floor.coordinator.on_feedback(fact(floor.a, 1));
  CHECK(floor.coordinator.ledger().versions(1).empty());
  floor.coordinator.begin_epoch(kEpoch + 5);
  CHECK(floor.coordinator.state().missing().size() == 2);
  CHECK(floor.ask(proposal).reasons()[0] == msg::REASON_WRONG_EPOCH);
}

TEST_CASE("every registration of a robot's agent is answered, with an echo of when it was sent") {
  Floor floor;
  const auto answer = [&](msg::Registration registration) {
    registration.head().stamp_ns(4711);
    const auto verdict = floor.coordinator.on_registration(registration);
    REQUIRE(verdict);
    CHECK(verdict->robot() == registration.robot());
    CHECK(verdict->epoch() == kEpoch);
    CHECK(verdict->proposal_number() == 0);
    CHECK(verdict->granted() == 0);
    CHECK(verdict->asked_stamp_ns() == 4711);
    return verdict->reasons()[0];
  };
  CHECK(answer(registration_of(floor.a, kEpoch + 50)) == msg::REASON_WRONG_EPOCH);
  CHECK(answer(registration_of(floor.a, kEpoch - 50)) == msg::REASON_WRONG_EPOCH);
  CHECK(floor.coordinator.state().missing().size() == 2);
  CHECK(answer(registration_of(floor.a, kEpoch, 2)) == msg::REASON_GRANTED);
  CHECK(answer(registration_of(floor.a, kEpoch, 2)) == msg::REASON_GRANTED);
  CHECK(answer(registration_of(floor.a, kEpoch, 1)) == msg::REASON_OLD_INCARNATION);
  auto malformed = registration_of(floor.b, kEpoch);
  malformed.version_count(0);
  CHECK(answer(malformed) == msg::REASON_MALFORMED);
  CHECK_FALSE(floor.coordinator.on_registration(registration_of(standing(3, {0, 0}), kEpoch)));
  malformed.head().sender(1);
  CHECK_FALSE(floor.coordinator.on_registration(malformed));
  CHECK(floor.coordinator.state().missing() == std::vector<std::uint32_t>{2});
}

TEST_CASE("a verdict echoes when the proposal that it answers was sent, a repeated one's too") {
  Floor floor;
  floor.register_both();
  auto proposal = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  proposal.head().stamp_ns(100);
  CHECK(floor.ask(proposal).asked_stamp_ns() == 100);
  proposal.head().stamp_ns(200);
  CHECK(floor.ask(proposal).asked_stamp_ns() == 200);
  CHECK(floor.ask(proposal).granted() == 10);
  proposal.epoch(kEpoch - 1);
  CHECK(floor.ask(proposal).asked_stamp_ns() == 200);
}

TEST_CASE("a registration that names one version twice is refused") {
  Floor floor;
  auto registration = registration_of(floor.a, kEpoch);
  registration.version_count(2);
  registration.versions()[1] = encode(standing(1, {1, 1}));
  floor.coordinator.on_registration(registration);
  CHECK(floor.coordinator.state().missing().size() == 2);
  CHECK(floor.coordinator.state().invalid() == 1);
}

TEST_CASE("a fact from a robot frees the places that it has left") {
  Floor floor;
  floor.register_both();
  const Version p = continued(floor.a, 10, 1, {0, 3});
  REQUIRE(floor.ask(proposal_of({p}, kEpoch)).granted() == 10);
  floor.coordinator.on_feedback(fact(p, 1.5));
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 10);
}

TEST_CASE("hostile proposals get a verdict with a reason, or none, and change nothing") {
  Floor floor;
  floor.register_both();
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const auto good = proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch);
  const auto spoil = [&](auto change) {
    auto proposal = good;
    change(proposal);
    return floor.ask(proposal).reasons()[0];
  };
  auto malformed = msg::REASON_MALFORMED;
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
        +[](msg::Proposal& p) { p.head().sender(2); }}) {
    auto proposal = good;
    change(proposal);
    CHECK_FALSE(floor.coordinator.on_proposal(proposal));
  }
  CHECK(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(2).size() == 1);
}

TEST_CASE("random messages of every kind never break the coordinator") {
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
        v.start_ns(static_cast<std::int64_t>(rng.bits()));
        break;
      case 3:
        v.phases()[0].duration_ns(static_cast<std::int64_t>(rng.bits()));
        break;
      case 4:
        v.base(rng.bits());
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
    (void)floor.coordinator.on_proposal(proposal);
    auto registration = registration_of(floor.b, kEpoch, rng.below(3));
    noise(registration.versions()[0]);
    registration.version_count(static_cast<std::uint8_t>(rng.bits()));
    floor.coordinator.on_registration(registration);
    auto feedback = fact(floor.a, 1);
    noise(feedback.executing());
    feedback.at_ns(static_cast<std::int64_t>(rng.bits()));
    feedback.is_off_reference(rng.chance(0.5));
    floor.coordinator.on_feedback(feedback);
    contradictions += floor.coordinator.is_contradicted();
    if (floor.coordinator.is_contradicted()) {
      floor.coordinator.begin_epoch(kEpoch);
      floor.register_both();
    }
    REQUIRE_FALSE(floor.coordinator.ledger().versions(1).empty());
    REQUIRE_FALSE(floor.coordinator.ledger().versions(2).empty());
  }
  CHECK(contradictions > 300);
  CHECK(floor.coordinator.state().grants() > 300);
}

TEST_CASE(
    "a fact that contradicts the ledger ends all granting until a new epoch begins with registrations") {
  Floor floor;
  floor.register_both();
  const Version unknown = continued(floor.a, 10, 1, {0, 3});
  floor.coordinator.on_feedback(fact(unknown, 1.5));
  CHECK(floor.coordinator.is_contradicted());
  CHECK(floor.ask(proposal_of({continued(floor.b, 20, 1, {0, 3})}, kEpoch)).granted() == 0);
  floor.coordinator.begin_epoch(kEpoch + 1);
  CHECK_FALSE(floor.coordinator.is_contradicted());
  CHECK_FALSE(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().missing().size() == 2);
}

TEST_CASE("a robot that lost its reference is where it says, and who that is in conflict with is named") {
  Floor floor;
  floor.register_both();
  Version stop = standing(1, {0.85, 0}, 1'000'000);
  stop.inflation_m = 0.01;
  auto feedback = fact(stop, 1);
  floor.coordinator.on_feedback(feedback);
  CHECK(floor.coordinator.is_contradicted());  // it does not say that it lost its reference
  floor.coordinator.begin_epoch(kEpoch);
  floor.register_both();
  feedback.is_off_reference(true);
  floor.coordinator.on_feedback(feedback);
  CHECK(floor.coordinator.is_granting());
  REQUIRE(floor.coordinator.ledger().versions(1).size() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
  const auto state = floor.coordinator.state();
  CHECK(state.conflicts() == 1);
  CHECK(state.conflict_first() == 1);
  CHECK(state.conflict_second() == 2);
  // Off its reference or not, what does not end at rest is no version.
  feedback.executing().vx_mps(1);
  feedback.executing().version_number(2'000'000);
  floor.coordinator.on_feedback(feedback);
  CHECK(floor.coordinator.state().invalid() == 1);
  CHECK(floor.coordinator.ledger().versions(1)[0].number == 1'000'000);
}

TEST_CASE("a robot that is not on the floor registers without versions and is granted nothing but a stand") {
  Floor floor;
  auto absent = registration_of(floor.a, kEpoch);
  absent.is_absent(true);
  CHECK(floor.coordinator.on_registration(absent)->reasons()[0] == msg::REASON_MALFORMED);
  absent.version_count(0);
  CHECK(floor.coordinator.on_registration(absent)->reasons()[0] == msg::REASON_GRANTED);
  floor.coordinator.on_registration(registration_of(floor.b, kEpoch));
  REQUIRE(floor.coordinator.is_granting());
  CHECK(floor.coordinator.state().absent() == 1);
  CHECK(floor.ask(proposal_of({continued(floor.a, 10, 1, {0, 3})}, kEpoch)).reasons()[0] ==
        msg::REASON_ABSENT);
  Version near = standing(1, {0.85, 0}, 11), there = standing(1, {0.5, 0.5}, 12);
  near.incarnation = there.incarnation = 1;
  const auto verdict = floor.ask(proposal_of({near, there}, kEpoch));
  CHECK(verdict.reasons()[0] == msg::REASON_CONFLICT);
  CHECK(verdict.granted() == 12);
  CHECK(floor.coordinator.state().absent() == 0);
}
