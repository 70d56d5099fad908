// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "common/messaging/codec.hpp"
#include "tests/unit/agents/agent/negotiation_driver.hpp"

using namespace sidestep;

TEST_CASE("an agent is silent until its robot has acknowledged it and the coordinator knows it") {
  Driver d;
  CHECK_FALSE(d.n.is_fenced());
  d.n.on_feedback(fact(d.stand, 0.1, kSelf - 1));
  CHECK_FALSE(d.n.is_fenced());
  d.n.on_coordinator_state(life_sign(kEpoch, {kRobot}), at_s(0.9));
  CHECK_FALSE(d.n.needs_registration());
  d.n.on_feedback(fact(d.stand, 0.2));
  CHECK(d.n.is_fenced());
  CHECK(d.n.needs_registration());
  CHECK(d.n.registration().version_count() == 1);
  CHECK(d.n.needs_registration());
  d.n.on_coordinator_state(life_sign(kEpoch, {7}), at_s(0.9));
  CHECK_FALSE(d.n.needs_registration());
  CHECK_FALSE(d.n.may_propose(at_s(0.95)));
  d.n.on_coordinator_state(life_sign(kEpoch), at_s(0.9));
  CHECK(d.n.may_propose(at_s(0.95)));
}

TEST_CASE(
    "an agent registers although the coordinator knows its robot from an earlier agent, until it is heard") {
  Driver d;
  d.n.on_feedback(fact(d.stand, 0.5));
  d.n.on_coordinator_state(life_sign(kEpoch), at_s(0.9));
  CHECK(d.n.needs_registration());
  CHECK_FALSE(d.n.may_propose(at_s(0.95)));
  (void)d.n.registration();
  CHECK(d.n.may_propose(at_s(0.95)));
  msg::Verdict refusal;
  refusal.robot(kRobot);
  refusal.epoch(kEpoch);
  refusal.proposal_number(d.propose(1.0, 0.9).candidates()[0].version_number());
  refusal.reasons().fill(msg::REASON_NOT_ALL_REGISTERED);
  (void)d.n.on_verdict(refusal, at_s(0.95));
  CHECK(d.n.needs_registration());
}

TEST_CASE("what was granted in time is forwarded and becomes the base of what follows") {
  Driver d;
  d.become_ready();
  const auto first = d.propose(1.0, 0.9);
  const auto version = d.grant(first, 0.95);
  REQUIRE(version);
  CHECK(version->number == first.candidates()[0].version_number());
  CHECK(d.n.base_at(at_s(1.05)).number == version->number);
  CHECK(d.n.base_at(at_s(0.99)).number == 0);
  CHECK(d.propose(1.05, 1.0).candidates()[0].base() == version->number);
}

TEST_CASE("a late verdict leaves the robot braking") {
  Driver d;
  d.become_ready();
  const auto proposal = d.propose(1.0, 0.9);
  CHECK_FALSE(d.grant(proposal, 1.0));
  CHECK(d.n.base_at(at_s(1.2)).number == 0);
  d.n.close_cycle(at_s(1.0));
  CHECK(d.n.counts().missed == 1);
}

TEST_CASE("a verdict is obeyed once, and of several grants for one start only the first is") {
  Driver d;
  d.become_ready();
  const auto first = d.propose(1.0, 0.9), again = d.propose(1.0, 0.93);
  CHECK_FALSE(d.grant(again, 0.96, kEpoch - 1));
  CHECK(d.grant(first, 0.96));
  CHECK_FALSE(d.grant(first, 0.97));
  CHECK_FALSE(d.grant(again, 0.97));
  CHECK(d.n.registration().version_count() == 2);
}

TEST_CASE("what was denied is neither forwarded nor registered") {
  Driver d;
  d.become_ready();
  const auto proposal = d.propose(1.0, 0.9);
  msg::Verdict denial;
  denial.robot(kRobot);
  denial.epoch(kEpoch);
  denial.proposal_number(proposal.candidates()[0].version_number());
  denial.granted(0);
  denial.reasons().fill(msg::REASON_CONFLICT);
  CHECK_FALSE(d.n.on_verdict(denial, at_s(0.95)));
  CHECK(d.n.counts().denials == 1);
  CHECK(d.n.base_at(at_s(1.05)).number == 0);
  CHECK(d.n.registration().version_count() == 1);
}

TEST_CASE("what was not answered is asked again while there is time, and not for ever") {
  Driver d;
  d.become_ready();
  (void)d.propose(2.0, 1.0);
  CHECK_FALSE(d.n.unanswered_start(at_s(1.01)));
  CHECK(d.n.unanswered_start(at_s(1.02)) == at_s(2.0));
  CHECK_FALSE(d.n.unanswered_start(at_s(1.99)));
  for (int i = 1; i < 4; ++i) (void)d.propose(2.0, 1.0 + 0.1 * i);
  CHECK_FALSE(d.n.unanswered_start(at_s(1.8)));
}

TEST_CASE("a coordinator that has fallen silent is not asked") {
  Driver d;
  d.become_ready();
  CHECK(d.n.may_propose(at_s(1.3)));
  CHECK_FALSE(d.n.may_propose(at_s(1.5)));
  d.n.on_coordinator_state(life_sign(kEpoch), at_s(1.6));
  CHECK(d.n.may_propose(at_s(1.7)));
}

TEST_CASE("a new agent learns from its robot which epoch it has obeyed, and ignores lower ones") {
  Driver d;
  d.n.on_feedback(fact(d.stand, 0.5, kSelf, kEpoch));
  d.n.on_coordinator_state(life_sign(kEpoch - 10), at_s(0.6));
  CHECK(d.n.epoch() == kEpoch);
  CHECK_FALSE(d.n.may_propose(at_s(0.7)));
  CHECK(d.n.registration().epoch() == kEpoch);
}

TEST_CASE("an agent registers in an epoch only once its robot has acknowledged it") {
  Driver d;
  d.n.on_feedback(fact(d.stand, 0.5, kSelf, 0));
  d.n.on_coordinator_state(life_sign(kEpoch, {kRobot}), at_s(0.6));
  CHECK(d.n.epoch() == kEpoch);
  CHECK_FALSE(d.n.needs_registration());
  d.n.on_feedback(fact(d.stand, 0.7, kSelf, kEpoch));
  CHECK(d.n.needs_registration());
}

TEST_CASE("a coordinator with a slow clock is told how far epochs have come, unless a later one is alive") {
  Driver d;
  d.become_ready();
  d.n.on_coordinator_state(life_sign(kEpoch - 1), at_s(1.0));
  CHECK_FALSE(d.n.needs_registration());
  d.n.on_coordinator_state(life_sign(kEpoch - 1), at_s(2.0));
  CHECK(d.n.needs_registration());
  CHECK(d.n.registration().epoch() == kEpoch);
}

TEST_CASE("an agent whose clock is behind an earlier one's begins above it, and yields once it was obeyed") {
  Driver d;
  d.n.on_feedback(fact(d.stand, 0.5, 5000));
  CHECK_FALSE(d.n.is_superseded());
  const Incarnation risen = d.n.incarnation();
  CHECK(risen > 5000);
  d.n.on_feedback(fact(d.stand, 0.6, risen));
  CHECK(d.n.is_fenced());
  d.n.on_feedback(fact(d.stand, 0.7, risen + 1));
  CHECK(d.n.is_superseded());
}

TEST_CASE("a verdict that grants what nobody proposed is not forwarded") {
  Driver d;
  d.become_ready();
  msg::Verdict verdict;
  verdict.robot(kRobot);
  verdict.epoch(kEpoch);
  verdict.proposal_number(d.propose(1.0, 0.9).candidates()[0].version_number());
  verdict.granted(424242);
  CHECK_FALSE(d.n.on_verdict(verdict, at_s(0.95)));
  CHECK(d.n.counts().invalid == 1);
}

TEST_CASE(
    "a higher epoch ends what is outstanding, lower ones are ignored, and all that may be executed is "
    "registered") {
  Driver d;
  d.become_ready();
  const auto forwarded = d.grant(d.propose(1.0, 0.9), 0.95);
  const auto outstanding = d.propose(1.05, 1.0);
  d.n.on_coordinator_state(life_sign(kEpoch + 1, {kRobot}), at_s(0.9));
  CHECK_FALSE(d.grant(outstanding, 1.01));
  CHECK_FALSE(d.grant(outstanding, 1.01, kEpoch + 1));
  d.n.on_feedback(fact(d.stand, 0.99, kSelf, kEpoch + 1));
  CHECK(d.n.needs_registration());
  d.n.on_coordinator_state(life_sign(kEpoch), at_s(0.9));
  CHECK(d.n.needs_registration());
  const auto registration = d.n.registration();
  CHECK(registration.epoch() == kEpoch + 1);
  REQUIRE(registration.version_count() == 2);
  CHECK(registration.versions()[0].version_number() == 0);
  CHECK(registration.versions()[1].version_number() == forwarded->number);
}

TEST_CASE("what facts have excluded is not registered any more") {
  Driver d;
  d.become_ready();
  const auto forwarded = d.grant(d.propose(1.0, 0.9), 0.95);
  d.n.on_feedback(fact(*forwarded, 1.01));
  d.n.on_coordinator_state(life_sign(kEpoch + 1, {kRobot}), at_s(0.9));
  const auto registration = d.n.registration();
  REQUIRE(registration.version_count() == 1);
  CHECK(registration.versions()[0].version_number() == forwarded->number);
}

TEST_CASE("a command that was lost is noticed, and the next proposal rests on what the robot executes") {
  Driver d;
  d.become_ready();
  const auto lost = d.grant(d.propose(1.0, 0.9), 0.95);
  REQUIRE(lost);
  (void)d.propose(1.05, 1.0);
  CHECK_FALSE(d.n.is_contradicted());
  d.n.on_feedback(fact(d.stand, 1.001));
  CHECK(d.n.is_contradicted());
  CHECK(d.n.counts().lost == 1);
  CHECK(d.propose(1.05, 1.01).candidates()[0].base() == 0);
  CHECK_FALSE(d.n.is_contradicted());
}

TEST_CASE("facts that arrive late change nothing") {
  Driver d;
  d.become_ready();
  const auto first = d.grant(d.propose(1.0, 0.9), 0.95);
  d.n.on_feedback(fact(*first, 1.01));
  d.n.on_feedback(fact(d.stand, 0.99));
  CHECK(d.n.executing().number == first->number);
  CHECK(d.n.counts().lost == 0);
}

TEST_CASE("an agent that a later one has fenced off falls silent") {
  Driver d;
  d.become_ready();
  const auto proposal = d.propose(1.0, 0.9);
  d.n.on_feedback(fact(d.stand, 0.92, kSelf + 1));
  CHECK(d.n.is_superseded());
  CHECK_FALSE(d.n.may_propose(at_s(0.95)));
  CHECK_FALSE(d.n.needs_registration());
  CHECK_FALSE(d.grant(proposal, 0.95));
}

TEST_CASE("version numbers grow over lives and candidates") {
  Driver d;
  d.become_ready();
  VersionNumber last = 0;
  for (int i = 0; i < 5; ++i) {
    const auto number = d.propose(1.0 + 0.1 * i, 0.9).candidates()[0].version_number();
    CHECK(number > last);
    last = number;
  }
  CHECK(last < kSelf + 100);
  // The robot executes a version of a later number: a clock went back.
  Negotiation other(kRobot, kSelf, from_seconds(1.0 / 60));
  Version ahead = d.stand;
  ahead.number = 5000;
  other.on_feedback(fact(ahead, 0.5));
  Trajectory rest = Trajectory::resting(at_s(1), {0, 0});
  CHECK(other.propose({&rest, 1}, 5000, at_s(0.9)).candidates()[0].version_number() > 5000);
}

TEST_CASE("malformed feedback is counted and changes nothing") {
  Driver d;
  d.become_ready();
  auto feedback = fact(d.stand, 1);
  feedback.executing().x_m(std::numeric_limits<double>::quiet_NaN());
  d.n.on_feedback(feedback);
  feedback = fact(d.stand, 1);
  feedback.executing().phase_count(99);
  d.n.on_feedback(feedback);
  CHECK(d.n.counts().invalid == 2);
  CHECK(d.n.executing().number == 0);
}
