// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/negotiation.hpp"

#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/agents/agent/negotiation_fixture.hpp"

namespace sidestep::negotiation_test {

using namespace negotiation_fixture;

TEST_CASE(
    "an agent proposes only after its robot has acknowledged it and the coordinator has registered it") {
  NegotiationFixture f;
  CHECK_FALSE(f.n.is_fenced());
  f.n.on_robot_report(make_report(f.initial, 0.1, kSelf - 1));
  CHECK_FALSE(f.n.is_fenced());
  f.n.on_coordinator_state(heartbeat(kEpoch, {kRobot}), at_s(0.9));
  CHECK_FALSE(f.n.needs_registration());
  f.n.on_robot_report(make_report(f.initial, 0.2));
  CHECK(f.n.is_fenced());
  CHECK(f.n.needs_registration());
  CHECK(f.n.registration().versions->versions().size() == 1);
  CHECK(f.n.needs_registration());
  f.n.on_coordinator_state(heartbeat(kEpoch, {7}), at_s(0.9));
  CHECK_FALSE(f.n.needs_registration());
  CHECK_FALSE(f.n.may_propose(at_s(0.95)));
  f.n.on_coordinator_state(heartbeat(kEpoch), at_s(0.9));
  CHECK(f.n.may_propose(at_s(0.95)));
}

TEST_CASE(
    "an agent repeats its registration until it is received, even if an earlier agent of its robot is "
    "registered") {
  NegotiationFixture f;
  f.n.on_robot_report(make_report(f.initial, 0.5));
  f.n.on_coordinator_state(heartbeat(kEpoch), at_s(0.9));
  CHECK(f.n.needs_registration());
  CHECK_FALSE(f.n.may_propose(at_s(0.95)));
  (void)f.n.registration();
  CHECK(f.n.may_propose(at_s(0.95)));
  Verdict refusal = verdict_on(f.propose(1.0, 0.9));
  refusal.reasons.fill(msg::Reason::REASON_NOT_ALL_REGISTERED);
  (void)f.n.on_verdict(refusal, at_s(0.95));
  CHECK(f.n.needs_registration());
}

TEST_CASE("a version granted in time is forwarded and becomes the base of later versions") {
  NegotiationFixture f;
  f.become_ready();
  const auto first = f.propose(1.0, 0.9);
  const auto version = f.grant(first, 0.95);
  REQUIRE(version);
  CHECK(version->number == first.candidates[0]->number);
  CHECK(f.n.held().base_at(at_s(1.05)).number == version->number);
  CHECK(f.n.held().base_at(at_s(0.99)).number == 0);
  CHECK(f.propose(1.05, 1.0).candidates[0]->base == version->number);
}

TEST_CASE("a late verdict leaves the robot braking") {
  NegotiationFixture f;
  f.become_ready();
  const auto proposal = f.propose(1.0, 0.9);
  CHECK_FALSE(f.grant(proposal, 1.0));
  CHECK(f.n.held().base_at(at_s(1.2)).number == 0);
  f.n.close_cycle(at_s(1.0));
  CHECK(f.n.counts().missed == 1);
}

TEST_CASE("each verdict is obeyed once, and only the first of several grants for the same start counts") {
  NegotiationFixture f;
  f.become_ready();
  const auto first = f.propose(1.0, 0.9), again = f.propose(1.0, 0.93);
  CHECK_FALSE(f.grant(again, 0.96, kEpoch - 1));
  CHECK(f.grant(first, 0.96));
  CHECK_FALSE(f.grant(first, 0.97));
  CHECK_FALSE(f.grant(again, 0.97));
  CHECK(f.n.registration().versions->versions().size() == 2);
}

TEST_CASE("a denied version is neither forwarded nor registered") {
  NegotiationFixture f;
  f.become_ready();
  const auto proposal = f.propose(1.0, 0.9);
  Verdict denial = verdict_on(proposal);
  denial.reasons.fill(msg::Reason::REASON_CONFLICT);
  CHECK_FALSE(f.n.on_verdict(denial, at_s(0.95)).granted);
  CHECK(f.n.counts().denials == 1);
  CHECK(f.n.held().base_at(at_s(1.05)).number == 0);
  CHECK(f.n.registration().versions->versions().size() == 1);
}

TEST_CASE("an unanswered proposal is repeated at most three times, and never shortly before its start") {
  NegotiationFixture f;
  f.become_ready();
  (void)f.propose(2.0, 1.0);
  CHECK_FALSE(f.n.retry_start(at_s(1.01)));
  CHECK(f.n.retry_start(at_s(1.02)) == at_s(2.0));
  CHECK_FALSE(f.n.retry_start(at_s(1.99)));
  for (int i = 1; i < 4; ++i) (void)f.propose(2.0, 1.0 + 0.1 * i);
  CHECK_FALSE(f.n.retry_start(at_s(1.8)));
}

TEST_CASE("nothing is proposed to a coordinator that has fallen silent") {
  NegotiationFixture f;
  f.become_ready();
  CHECK(f.n.may_propose(at_s(1.3)));
  CHECK_FALSE(f.n.may_propose(at_s(1.5)));
  f.n.on_coordinator_state(heartbeat(kEpoch), at_s(1.6));
  CHECK(f.n.may_propose(at_s(1.7)));
}

TEST_CASE("an agent stops proposing two cycles after its robot's last fact, and resumes with the next fact") {
  NegotiationFixture f;
  f.become_ready();
  REQUIRE(f.n.lead() == 1);
  int cycles = 0;
  for (; f.n.may_propose(at_s(1.0)) && cycles < 100; ++cycles) f.n.close_cycle(at_s(1.0));
  CHECK(cycles == 3);
  CHECK(f.n.wait_reason(at_s(1.0)) == WaitReason::kRobotSilent);
  f.n.on_robot_report(make_report(f.initial, 1.0));
  CHECK(f.n.may_propose(at_s(1.0)));
}

TEST_CASE("times of different incarnations of a robot are not compared") {
  NegotiationFixture f;
  f.become_ready();
  const auto own_stop = [](VersionNumber number, double start) {
    return Version{kRobot, kSelf, number, 0, Trajectory::resting(at_s(start), {0.1, 0})};
  };
  const auto report_of = [&](Incarnation robot, const Version& executing, double at) {
    RobotReport robot_report = make_report(executing, at);
    robot_report.robot_incarnation = robot;
    robot_report.is_off_reference = true;
    return robot_report;
  };
  f.n.on_robot_report(report_of(1, own_stop(5000, 3600), 3600));
  REQUIRE(f.n.held().executing().number == 5000);
  // The robot's clock has been set back.
  f.n.on_robot_report(report_of(2, own_stop(9000, 10), 10));
  CHECK(f.n.held().executing().number == 9000);
  SECTION("a late fact of the earlier incarnation changes nothing") {
    f.n.on_robot_report(report_of(1, own_stop(5000, 3600), 3601));
    CHECK(f.n.held().executing().number == 9000);
    f.n.on_robot_report(report_of(2, own_stop(7000, 10), 9));
    CHECK(f.n.held().executing().number == 9000);
    // A robot never returns to an earlier incarnation, so the previous fact was false.
    f.n.on_robot_report(report_of(2, own_stop(7000, 10), 11));
    CHECK(f.n.held().executing().number == 7000);
  }
  SECTION("after a false fact of a later incarnation, sixty true facts are believed again") {
    f.n.on_robot_report(report_of(99, own_stop(20'000, 10), 3000));
    REQUIRE(f.n.held().executing().number == 20'000);
    int reports = 0;
    for (; f.n.held().executing().number != 9000 && reports < 1000; ++reports)
      f.n.on_robot_report(report_of(2, own_stop(9000, 10), 11 + 0.01 * reports));
    CHECK(reports == 60);
  }
  SECTION("a lifting in a later incarnation takes effect") {
    RobotReport lifted = report_of(3, f.initial, 11);
    lifted.is_off_reference = false;
    lifted.is_lifted = true;
    f.n.on_robot_report(lifted);
    CHECK(f.n.is_absent());
  }
}

TEST_CASE("a superseded agent continues if its robot obeys it again after the robot's clock was set back") {
  NegotiationFixture f;
  f.become_ready();
  f.n.on_robot_report(make_report(f.initial, 3600, f.n.incarnation() + 5));
  REQUIRE(f.n.is_superseded());
  RobotReport robot_report = make_report(f.initial, 1, f.n.incarnation());
  f.n.on_robot_report(robot_report);
  CHECK(f.n.is_superseded());
  robot_report.robot_incarnation = 7;
  f.n.on_robot_report(robot_report);
  CHECK_FALSE(f.n.is_superseded());
}

TEST_CASE("a superseded agent queries its robot only when the robot has fallen silent") {
  NegotiationFixture f;
  f.become_ready();
  for (int cycle = 0; cycle < 40; ++cycle) f.n.close_cycle(at_s(1));
  CHECK_FALSE(f.n.must_query_robot());
  for (int cycle = 0; cycle < 40; ++cycle) {
    f.n.on_robot_report(make_report(f.initial, 2 + 0.01 * cycle, f.n.incarnation() + 1));
    f.n.close_cycle(at_s(2));
    REQUIRE(f.n.is_superseded());
    CHECK_FALSE(f.n.must_query_robot());
  }
  int cycles = 1;  // cycles since the last fact
  for (; !f.n.must_query_robot() && cycles < 100; ++cycles) f.n.close_cycle(at_s(3));
  CHECK(cycles == 30);  // half a second
  CHECK(f.n.is_superseded());
  CHECK_FALSE(f.n.may_propose(at_s(3)));
  CHECK_FALSE(f.n.needs_registration());
  f.n.on_robot_report(make_report(f.initial, 4, f.n.incarnation() + 1));
  CHECK_FALSE(f.n.must_query_robot());
}

TEST_CASE("an agent keeps proposing although a wrong clock made a granted version start an hour later") {
  NegotiationFixture f;
  f.become_ready();
  const auto granted = f.grant(f.propose(3600, 0.96), 0.97);
  REQUIRE(granted);
  CHECK_FALSE(f.n.has_upcoming_version(at_s(1.0)));
  const auto next = f.grant(f.propose(1.1, 1.0), 1.01);
  REQUIRE(next);
  CHECK(f.n.has_upcoming_version(at_s(1.0)));
  CHECK(next->base == f.initial.number);
  // The robot may still be executing any of the three versions.
  CHECK(f.n.registration().versions->versions().size() == 3);
  f.n.on_robot_report(make_report(*next, 1.2));
  CHECK(f.n.registration().versions->versions().size() == 1);
}

TEST_CASE("an agent that hears no coordinator or is not served asks for another coordinator") {
  NegotiationFixture f;
  CHECK_FALSE(f.n.needs_other_coordinator(at_s(0.5)));
  SECTION("no coordinator was ever heard") {
    f.n.on_robot_report(make_report(f.initial, 0.5, kSelf, 0));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(2.4)));
    CHECK(f.n.needs_other_coordinator(at_s(2.5)));
  }
  SECTION("heartbeats stop") {
    f.become_ready();
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.3)));
    CHECK(f.n.needs_other_coordinator(at_s(1.4)));
    f.n.on_coordinator_state(heartbeat(kEpoch), at_s(1.4));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.5)));
    // The last heartbeat came while the clock was ahead.
    f.n.on_coordinator_state(heartbeat(kEpoch), at_s(100));
    CHECK(f.n.needs_other_coordinator(at_s(2)));
    CHECK(f.n.wait_reason(at_s(2)) == WaitReason::kNoCoordinator);
  }
  SECTION("answers stop") {
    f.become_ready();
    const Proposal first = f.propose(1.1, 1.0);
    (void)f.propose(1.2, 1.1);
    f.n.on_coordinator_state(heartbeat(kEpoch), at_s(1.3));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.39)));
    CHECK(f.n.needs_other_coordinator(at_s(1.4)));
    (void)f.n.on_verdict(verdict_on(first), at_s(1.41));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.42)));
    f.n.on_request(at_s(1.5));
    f.n.on_coordinator_state(heartbeat(kEpoch), at_s(1.8));
    CHECK(f.n.needs_other_coordinator(at_s(1.9)));
    Verdict registered = verdict_on(first);
    registered.proposal_number = 0;
    (void)f.n.on_verdict(registered, at_s(1.9));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.9)));
  }
  SECTION("the coordinator does not hear the robot") {
    f.become_ready();
    const auto reason = GENERATE(msg::Reason::REASON_LEDGER_FULL, msg::Reason::REASON_BASE_UNKNOWN);
    for (int i = 0; i < 8; ++i) {
      const double now = 1 + 0.05 * i;
      f.n.on_coordinator_state(heartbeat(kEpoch), at_s(now));
      CHECK_FALSE(f.n.needs_other_coordinator(at_s(now)));
      Verdict verdict = verdict_on(f.propose(now + 0.1, now));
      verdict.reasons.fill(reason);
      (void)f.n.on_verdict(verdict, at_s(now));
    }
    f.n.on_coordinator_state(heartbeat(kEpoch), at_s(1.4));
    CHECK(f.n.needs_other_coordinator(at_s(1.4)));
    Verdict conflict = verdict_on(f.propose(1.6, 1.45));
    conflict.reasons.fill(msg::Reason::REASON_CONFLICT);
    (void)f.n.on_verdict(conflict, at_s(1.45));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(1.45)));
  }
  SECTION("the robot does not acknowledge the epoch, which is not the coordinator's fault") {
    f.become_ready();
    f.n.on_coordinator_state(heartbeat(kEpoch + 8), at_s(1));
    CHECK_FALSE(f.n.needs_other_coordinator(at_s(9)));
  }
}

TEST_CASE("a new agent learns the obeyed epoch from its robot and ignores lower ones") {
  NegotiationFixture f;
  f.n.on_robot_report(make_report(f.initial, 0.5, kSelf, kEpoch));
  f.n.on_coordinator_state(heartbeat(kEpoch - 10), at_s(0.6));
  CHECK(f.n.epoch() == kEpoch);
  CHECK_FALSE(f.n.may_propose(at_s(0.7)));
  CHECK(f.n.registration().epoch == kEpoch);
}

TEST_CASE("an agent registers in an epoch only once its robot has acknowledged it") {
  NegotiationFixture f;
  f.n.on_robot_report(make_report(f.initial, 0.5, kSelf, 0));
  f.n.on_coordinator_state(heartbeat(kEpoch, {kRobot}), at_s(0.6));
  CHECK(f.n.epoch() == kEpoch);
  CHECK_FALSE(f.n.needs_registration());
  f.n.on_robot_report(make_report(f.initial, 0.7, kSelf, kEpoch));
  CHECK(f.n.needs_registration());
}

TEST_CASE("a coordinator of a lower epoch learns the highest epoch once the later coordinator is silent") {
  NegotiationFixture f;
  f.become_ready();
  f.n.on_coordinator_state(heartbeat(kEpoch - 1), at_s(1.0));
  CHECK_FALSE(f.n.needs_registration());
  f.n.on_coordinator_state(heartbeat(kEpoch - 1), at_s(2.0));
  CHECK(f.n.needs_registration());
  CHECK(f.n.registration().epoch == kEpoch);
}

TEST_CASE(
    "an agent with a slow clock raises its incarnation above its predecessor's, and is superseded only after "
    "its robot has obeyed it") {
  NegotiationFixture f;
  f.n.on_robot_report(make_report(f.initial, 0.5, 5000));
  CHECK_FALSE(f.n.is_superseded());
  const Incarnation risen = f.n.incarnation();
  CHECK(risen > 5000);
  f.n.on_robot_report(make_report(f.initial, 0.6, risen));
  CHECK(f.n.is_fenced());
  f.n.on_robot_report(make_report(f.initial, 0.7, risen + 1));
  CHECK(f.n.is_superseded());
}

TEST_CASE("a superseded agent continues if a later fact acknowledges it, but not if an earlier fact does") {
  NegotiationFixture f;
  f.become_ready();
  const Incarnation self = f.n.incarnation();
  f.n.on_robot_report(make_report(f.initial, 0.8, self + 5));
  f.n.on_robot_report(make_report(f.initial, 0.7, self + 9));
  REQUIRE(f.n.is_superseded());
  CHECK_FALSE(f.n.may_propose(at_s(0.8)));
  f.n.on_robot_report(make_report(f.initial, 0.8, self));
  CHECK(f.n.is_superseded());
  f.n.on_robot_report(make_report(f.initial, 0.81, self));
  CHECK_FALSE(f.n.is_superseded());
  CHECK(f.n.may_propose(at_s(0.82)));
}

TEST_CASE("a grant of an unknown version is not forwarded") {
  NegotiationFixture f;
  f.become_ready();
  Verdict verdict = verdict_on(f.propose(1.0, 0.9));
  verdict.granted_version = 424242;
  CHECK_FALSE(f.n.on_verdict(verdict, at_s(0.95)).granted);
  CHECK(f.n.counts().unproposed_grants == 1);
}

TEST_CASE(
    "a higher epoch cancels proposals, a lower epoch is ignored, and every version that may be executed is "
    "registered") {
  NegotiationFixture f;
  f.become_ready();
  const auto forwarded = f.grant(f.propose(1.0, 0.9), 0.95);
  const auto outstanding = f.propose(1.05, 1.0);
  f.n.on_coordinator_state(heartbeat(kEpoch + 1, {kRobot}), at_s(0.9));
  CHECK_FALSE(f.grant(outstanding, 1.01));
  CHECK_FALSE(f.grant(outstanding, 1.01, kEpoch + 1));
  f.n.on_robot_report(make_report(f.initial, 0.99, kSelf, kEpoch + 1));
  CHECK(f.n.needs_registration());
  f.n.on_coordinator_state(heartbeat(kEpoch), at_s(0.9));
  CHECK(f.n.needs_registration());
  const auto registration = f.n.registration();
  CHECK(registration.epoch == kEpoch + 1);
  REQUIRE(registration.versions->versions().size() == 2);
  CHECK(registration.versions->versions()[0].number == 0);
  CHECK(registration.versions->versions()[1].number == forwarded->number);
}

TEST_CASE("versions that facts have excluded are not registered") {
  NegotiationFixture f;
  f.become_ready();
  const auto forwarded = f.grant(f.propose(1.0, 0.9), 0.95);
  f.n.on_robot_report(make_report(*forwarded, 1.01));
  f.n.on_coordinator_state(heartbeat(kEpoch + 1, {kRobot}), at_s(0.9));
  const auto registration = f.n.registration();
  REQUIRE(registration.versions->versions().size() == 1);
  CHECK(registration.versions->versions()[0].number == forwarded->number);
}

TEST_CASE("a lost command is detected, and the next proposal is based on what the robot executes") {
  NegotiationFixture f;
  f.become_ready();
  const auto lost = f.grant(f.propose(1.0, 0.9), 0.95);
  REQUIRE(lost);
  (void)f.propose(1.05, 1.0);
  CHECK_FALSE(f.n.is_contradicted());
  f.n.on_robot_report(make_report(f.initial, 1.001));
  CHECK(f.n.is_contradicted());
  CHECK(f.n.counts().lost == 1);
  CHECK(f.propose(1.05, 1.01).candidates[0]->base == 0);
  CHECK_FALSE(f.n.is_contradicted());
}

TEST_CASE("late facts change nothing") {
  NegotiationFixture f;
  f.become_ready();
  const auto first = f.grant(f.propose(1.0, 0.9), 0.95);
  f.n.on_robot_report(make_report(*first, 1.01));
  f.n.on_robot_report(make_report(f.initial, 0.99));
  CHECK(f.n.held().executing().number == first->number);
  CHECK(f.n.counts().lost == 0);
}

TEST_CASE("a late fact from before a lifting does not exclude the rest version granted after the lifting") {
  NegotiationFixture f;
  RobotReport lifted = make_report(f.initial, 0.5);
  lifted.is_lifted = true;
  f.n.on_robot_report(lifted);
  f.n.on_coordinator_state(heartbeat(kEpoch), at_s(0.9));
  (void)f.n.registration();
  const Trajectory rest = Trajectory::resting(at_s(1), {2, 0});
  const auto granted = f.grant(f.n.propose({&rest, 1}, 0, at_s(0.9)), 0.95);
  REQUIRE(granted);
  // The robot sent this fact after the fencing but before the lifting.
  f.n.on_robot_report(make_report(f.initial, 0.4));
  CHECK(f.n.is_absent());
  f.n.on_coordinator_state(heartbeat(kEpoch + 1, {kRobot}), at_s(0.97));
  lifted.valid_at = at_s(0.98);
  lifted.obeyed_epoch = kEpoch + 1;
  f.n.on_robot_report(lifted);
  REQUIRE(f.n.needs_registration());
  const auto registration = f.n.registration();
  REQUIRE(registration.versions->versions().size() == 1);
  CHECK(registration.versions->versions()[0].number == granted->number);
}

TEST_CASE("an agent numbers a rest version above the robot's last version, even if it was unreported") {
  NegotiationFixture f;
  f.become_ready();
  const VersionNumber unreported_stop = f.propose(1, 0.96).candidates[0]->number + (VersionNumber{1} << 20);
  RobotReport lifted = make_report(f.initial, 0.97);
  lifted.is_lifted = true;
  lifted.executing.base = unreported_stop;
  f.n.on_robot_report(lifted);
  REQUIRE(f.n.is_absent());
  const Trajectory rest = Trajectory::resting(at_s(1.1), {2, 0});
  CHECK(f.n.propose({&rest, 1}, 0, at_s(1)).candidates[0]->number > unreported_stop);
}

TEST_CASE("an agent recovers from a false fact about a version that its robot does not execute") {
  NegotiationFixture f;
  f.become_ready();
  const auto granted = f.grant(f.propose(1, 0.96), 0.97);
  REQUIRE(granted);
  f.n.on_robot_report(make_report(*granted, 1.01));
  Version forged = *granted;
  forged.number += 1000;
  f.n.on_robot_report(make_report(forged, 1.02));
  CHECK(f.n.held().executing().number == forged.number);
  f.n.on_robot_report(make_report(*granted, 1.0));  // arrives late
  CHECK(f.n.held().executing().number == forged.number);
  f.n.on_robot_report(make_report(*granted, 1.03));
  CHECK(f.n.held().executing().number == granted->number);
  CHECK(f.n.is_contradicted());
}

TEST_CASE("an agent falls silent when a later agent has fenced its robot") {
  NegotiationFixture f;
  f.become_ready();
  const auto proposal = f.propose(1.0, 0.9);
  f.n.on_robot_report(make_report(f.initial, 0.92, kSelf + 1));
  CHECK(f.n.is_superseded());
  CHECK_FALSE(f.n.may_propose(at_s(0.95)));
  CHECK_FALSE(f.n.needs_registration());
  CHECK_FALSE(f.grant(proposal, 0.95));
}

TEST_CASE("version numbers increase across incarnations and candidates") {
  NegotiationFixture f;
  f.become_ready();
  VersionNumber last = 0;
  for (int i = 0; i < 5; ++i) {
    const auto number = f.propose(1.0 + 0.1 * i, 0.9).candidates[0]->number;
    CHECK(number > last);
    last = number;
  }
  CHECK(last < kSelf + 100);
  // The robot executes a version with a higher number, because the host's clock was set back.
  Negotiation other(kRobot, kSelf, from_seconds(1.0 / 60));
  Version ahead = f.initial;
  ahead.number = 5000;
  other.on_robot_report(make_report(ahead, 0.5));
  Trajectory rest = Trajectory::resting(at_s(1), {0, 0});
  CHECK(other.propose({&rest, 1}, 5000, at_s(0.9)).candidates[0]->number > 5000);
}

TEST_CASE(
    "a round trip is measured for a verdict on an open or late proposal, but not for an unexpected one") {
  NegotiationFixture f;
  f.become_ready();
  Verdict verdict = verdict_on(f.propose(1.0, 0.9));
  verdict.granted_version = verdict.proposal_number;
  Verdict unexpected = verdict;
  ++unexpected.proposal_number;
  CHECK_FALSE(f.n.on_verdict(unexpected, at_s(1.1)).round_trip);
  const auto late = f.n.on_verdict(verdict, at_s(1.1));
  CHECK_FALSE(late.granted);
  CHECK(late.round_trip == at_s(1.1) - at_s(0.9));
  CHECK_FALSE(f.n.on_verdict(verdict, at_s(1.1)).round_trip);
}

}  // namespace sidestep::negotiation_test
