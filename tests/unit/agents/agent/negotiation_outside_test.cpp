// SPDX-License-Identifier: Apache-2.0
// Robots that are pushed, lifted, put down elsewhere, or were driven by another agent.
#include "agents/agent/negotiation.hpp"
#include "tests/catch.hpp"
#include "tests/unit/agents/agent/negotiation_fixture.hpp"

namespace sidestep::negotiation_outside_test {

using namespace negotiation_fixture;

/// Whether the registration declares the robot absent.
bool is_empty(const Registration& registration) { return registration.versions->versions().empty(); }

TEST_CASE("a robot's own stop is the base of later versions, which have higher numbers") {
  NegotiationFixture f;
  f.become_ready();
  const auto pending = f.grant(f.propose(1.0, 0.9), 0.95);
  REQUIRE(pending);
  Trajectory stop(at_s(0.97), {{0.1, 0}, {0.5, 0}});
  append_stop(stop, 5);
  Version off = f.initial;
  off.number = kSelf + (VersionNumber{1} << 32);
  off.trajectory = stop;
  off.inflation_m = 0.02;
  auto robot_report = make_report(off, 0.98);
  robot_report.is_off_reference = true;
  f.n.on_robot_report(robot_report);
  CHECK(f.n.held().executing().number == off.number);
  CHECK(f.n.held().executing().inflation_m == 0.02);
  CHECK(f.n.is_contradicted());
  CHECK(f.n.registration().versions->versions().size() == 1);
  // An earlier fact arrives late.
  f.n.on_robot_report(make_report(f.initial, 0.96));
  CHECK(f.n.held().executing().number == off.number);
  const Trajectory next = Trajectory::resting(at_s(1.5), {0.125, 0});
  const auto proposal = f.n.propose({&next, 1}, f.n.held().base_at(at_s(1.5)).number, at_s(1.4));
  CHECK(proposal.candidates[0]->base == off.number);
  CHECK(proposal.candidates[0]->number > off.number);
  CHECK(proposal.candidates[0]->inflation_m == 0);
}

TEST_CASE("an unknown version that the robot executes replaces all versions that the agent holds") {
  NegotiationFixture f;
  f.become_ready();
  Version unknown = f.initial;
  unknown.number = 700;
  unknown.trajectory = Trajectory::resting(at_s(0.9), {3, 3});
  f.n.on_robot_report(make_report(unknown, 1));
  REQUIRE(f.n.registration().versions->versions().size() == 1);
  CHECK(f.n.registration().versions->versions()[0].number == 700);
}

TEST_CASE("a lifted robot holds no version, registers as absent, and proposes a rest version on base 0") {
  NegotiationFixture f;
  f.become_ready();
  const auto pending = f.grant(f.propose(1.0, 0.9), 0.95);
  REQUIRE(pending);
  Version none{kRobot, 0, 0, 0, Trajectory::resting(at_s(1.1), {0, 0})};
  const auto lifted = [&](double at, const Version& executing, Incarnation obeyed = kSelf) {
    auto robot_report = make_report(executing, at, obeyed);
    robot_report.is_lifted = true;
    return robot_report;
  };
  f.n.on_robot_report(lifted(1.1, none));
  REQUIRE(f.n.is_absent());
  CHECK(is_empty(f.n.registration()));
  CHECK_FALSE(f.n.has_upcoming_version(at_s(1.2)));
  const Trajectory place = Trajectory::resting(at_s(1.3), {2, 1});
  const auto proposal = f.n.propose({&place, 1}, 0, at_s(1.2));
  CHECK(f.n.has_upcoming_version(at_s(1.2)));
  f.n.on_robot_report(lifted(1.21, none));
  const auto rest = f.grant(proposal, 1.25);
  REQUIRE(rest);
  CHECK(rest->base == 0);
  CHECK(f.n.is_absent());
  CHECK_FALSE(is_empty(f.n.registration()));  // the robot may execute the rest version
  CHECK(f.n.has_upcoming_version(at_s(1.26)));
  f.n.on_robot_report(lifted(1.31, *rest));
  CHECK_FALSE(f.n.is_absent());
  // A fact from before the robot executed the rest version arrives late. Then the robot is lifted again.
  f.n.on_robot_report(lifted(1.28, none));
  CHECK_FALSE(f.n.is_absent());
  CHECK(f.n.held().base_at(at_s(2)).number == rest->number);
  f.n.on_robot_report(lifted(1.4, none));
  CHECK(f.n.is_absent());

  Negotiation successor(kRobot, kSelf + 1, from_seconds(1.0 / 60));
  successor.on_robot_report(lifted(1.5, none, kSelf + 1));
  CHECK(successor.is_absent());
  CHECK(is_empty(successor.registration()));
}

TEST_CASE("a rest version that the robot did not receive in time is proposed again") {
  NegotiationFixture f;
  f.become_ready();
  Version none{kRobot, 0, 0, 0, Trajectory::resting(at_s(1), {0, 0})};
  auto lifted = make_report(none, 1.1);
  lifted.is_lifted = true;
  f.n.on_robot_report(lifted);
  const auto lost_before = f.n.counts().lost;
  const Trajectory place = Trajectory::resting(at_s(1.3), {2, 1});
  REQUIRE(f.grant(f.n.propose({&place, 1}, 0, at_s(1.2)), 1.25));
  lifted.valid_at = at_s(1.31);
  f.n.on_robot_report(lifted);
  CHECK(f.n.is_absent());
  CHECK(f.n.counts().lost == lost_before + 1);
  CHECK_FALSE(f.n.has_upcoming_version(at_s(1.32)));
  CHECK(is_empty(f.n.registration()));
}

}  // namespace sidestep::negotiation_outside_test
