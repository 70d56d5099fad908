// SPDX-License-Identifier: Apache-2.0
// Robots that somebody pushes, lifts and puts down elsewhere, or whom another agent has driven.
#include <catch2/catch.hpp>

#include "agents/agent/negotiation.hpp"
#include "tests/unit/agents/agent/negotiation_driver.hpp"

using namespace sidestep;

TEST_CASE(
    "the stop of a robot that lost its reference is the base of what follows, and versions go above it") {
  Driver d;
  d.become_ready();
  const auto pending = d.grant(d.propose(1.0, 0.9), 0.95);
  REQUIRE(pending);
  Trajectory stop(at_s(0.97), {{0.1, 0}, {0.5, 0}});
  append_stop(stop, 5);
  Version off = d.stand;
  off.number = kSelf + (VersionNumber{1} << 32);
  off.trajectory = stop;
  off.inflation_m = 0.02;
  auto feedback = fact(off, 0.98);
  feedback.is_off_reference(true);
  d.n.on_feedback(feedback);
  CHECK(d.n.executing().number == off.number);
  CHECK(d.n.executing().inflation_m == 0.02);
  CHECK(d.n.is_contradicted());
  CHECK(d.n.registration().version_count() == 1);
  // What was told before comes late.
  d.n.on_feedback(fact(d.stand, 0.96));
  CHECK(d.n.executing().number == off.number);
  const Trajectory next = Trajectory::resting(at_s(1.5), {0.125, 0});
  const auto proposal = d.n.propose({&next, 1}, d.n.base_at(at_s(1.5)).number, at_s(1.4), 0.02);
  CHECK(proposal.candidates()[0].base() == off.number);
  CHECK(proposal.candidates()[0].version_number() > off.number);
  CHECK(proposal.candidates()[0].inflation_m() == 0.02);
}

TEST_CASE("what the robot executes and this agent knows nothing of takes the place of all that it knew") {
  Driver d;
  d.become_ready();
  Version unknown = d.stand;
  unknown.number = 700;
  unknown.trajectory = Trajectory::resting(at_s(0.9), {3, 3});
  d.n.on_feedback(fact(unknown, 1));
  REQUIRE(d.n.registration().version_count() == 1);
  CHECK(d.n.registration().versions()[0].version_number() == 700);
}

TEST_CASE("a lifted robot holds nothing, registers as absent, and asks for a stand on base 0") {
  Driver d;
  d.become_ready();
  const auto pending = d.grant(d.propose(1.0, 0.9), 0.95);
  REQUIRE(pending);
  Version none{kRobot, 0, 0, 0, Trajectory::resting(at_s(1.1), {0, 0})};
  const auto lifted = [&](double at, const Version& executing, Incarnation obeyed = kSelf) {
    auto feedback = fact(executing, at, obeyed);
    feedback.is_lifted(true);
    return feedback;
  };
  d.n.on_feedback(lifted(1.1, none));
  REQUIRE(d.n.is_absent());
  CHECK(d.n.registration().is_absent());
  CHECK(d.n.registration().version_count() == 0);
  CHECK_FALSE(d.n.is_settled_after(at_s(1.2)));
  const Trajectory place = Trajectory::resting(at_s(1.3), {2, 1});
  const auto proposal = d.n.propose({&place, 1}, 0, at_s(1.2));
  CHECK(d.n.is_settled_after(at_s(1.2)));
  d.n.on_feedback(lifted(1.21, none));
  const auto stand = d.grant(proposal, 1.25);
  REQUIRE(stand);
  CHECK(stand->base == 0);
  CHECK(d.n.is_absent());
  CHECK_FALSE(d.n.registration().is_absent());  // it may take the stand
  CHECK(d.n.is_settled_after(at_s(1.26)));
  d.n.on_feedback(lifted(1.31, *stand));
  CHECK_FALSE(d.n.is_absent());
  // Told late that it held nothing; then it is lifted once more.
  d.n.on_feedback(lifted(1.28, none));
  CHECK_FALSE(d.n.is_absent());
  CHECK(d.n.base_at(at_s(2)).number == stand->number);
  d.n.on_feedback(lifted(1.4, none));
  CHECK(d.n.is_absent());

  Negotiation heir(kRobot, kSelf + 1, from_seconds(1.0 / 60));
  heir.on_feedback(lifted(1.5, none, kSelf + 1));
  CHECK(heir.is_absent());
  CHECK(heir.registration().is_absent());
}

TEST_CASE("a stand that the robot did not take in time is asked for again") {
  Driver d;
  d.become_ready();
  Version none{kRobot, 0, 0, 0, Trajectory::resting(at_s(1), {0, 0})};
  auto lifted = fact(none, 1.1);
  lifted.is_lifted(true);
  d.n.on_feedback(lifted);
  const auto lost_before = d.n.counts().lost;
  const Trajectory place = Trajectory::resting(at_s(1.3), {2, 1});
  REQUIRE(d.grant(d.n.propose({&place, 1}, 0, at_s(1.2)), 1.25));
  lifted.at_ns(to_ns(at_s(1.31)));
  d.n.on_feedback(lifted);
  CHECK(d.n.is_absent());
  CHECK(d.n.counts().lost == lost_before + 1);
  CHECK_FALSE(d.n.is_settled_after(at_s(1.32)));
  CHECK(d.n.registration().is_absent());
}
