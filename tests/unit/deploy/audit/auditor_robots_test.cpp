// SPDX-License-Identifier: Apache-2.0
// Single robot reports as evidence.
#include "common/motion/safety_budget.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_robots_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("a report that contradicts the previous report is counted as one violation per contradiction") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1);
  stage.drive(first);
  REQUIRE(stage.violations.empty());
  msg::Feedback& robot_report = stage.robot_reports[0];
  std::uint64_t expected = 0;
  SECTION("the report has the same time") { robot_report.valid_at_ns(to_ns(stage.now)); }
  SECTION("the report has an earlier time") {
    robot_report.valid_at_ns(to_ns(stage.now) - 1);
    // The executed version also starts later than the report.
    expected = 2;
  }
  SECTION("the robot obeys an older agent") {
    robot_report.obeyed_incarnation(Stage::kAgent - 1);
    // The robot has not acknowledged the agent that registered, either.
    stage.report(0);
    CHECK(stage.count(AuditRule::kFacts) == 1);
    return;
  }
  SECTION("the robot obeys a newer agent") { robot_report.obeyed_incarnation(Stage::kAgent + 1); }
  SECTION("the robot obeys an older epoch") {
    robot_report.obeyed_epoch(stage.epoch - 1);
    // The robot cannot have registered in the epoch of the grant, either.
    stage.report(0);
    CHECK(stage.count(AuditRule::kFacts) == 1);
    return;
  }
  SECTION("the robot obeys a newer epoch") { robot_report.obeyed_epoch(stage.epoch + 1); }
  SECTION("the robot executes the initial rest") {
    stage.advance(1ms);
    robot_report.executing(stage.rest(0));
    // The report that the robot executes the version has excluded the rest.
    expected = 2;
  }
  stage.report(0);
  check_only(stage, AuditRule::kFacts, expected);
}

TEST_CASE("a robot must not execute a version before its start") {
  const Duration early = GENERATE(0ns, 1ns);
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1);
  stage.grant(first);
  stage.command(first);
  stage.now = time_from_ns(first.start_ns()) - early;
  stage.robot_reports[0].executing(first);
  stage.report(0);
  check_only(stage, AuditRule::kFacts, early == 0ns ? 0 : 1);
}

TEST_CASE("a report with an earlier time is a violation only if no clock was set back in between") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  stage.advance(10ms);
  stage.report(0);
  const std::int64_t early_ns = to_ns(stage.now) - 100'000;
  std::uint64_t expected = 0;
  SECTION("the report follows directly") { expected = 1; }
  SECTION("a report was missed") {
    (void)stage.header("feedback", 0);
    expected = is_complete ? 1 : 0;
  }
  SECTION("the last report was made by a clock out of bounds") {
    stage.robot_reports[0].valid_at_ns(to_ns(stage.now) + 100'000'000);
    stage.report(0);
  }
  stage.robot_reports[0].valid_at_ns(early_ns);
  stage.report(0);
  check_only(stage, AuditRule::kFacts, expected);
}

TEST_CASE("a robot may switch only from a version's base to the version") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1, 50ms), second = stage.next(first, 2, 60ms),
                     third = stage.next(second, 3, 70ms), other = stage.next(stage.rest(0), 4, 80ms);
  const msg::Version moved = moving(stage.next(stage.rest(0), 5, 90ms), 0.1);
  for (const auto& version : {first, second, third, other, moved}) {
    stage.grant(version);
    stage.command(version);
  }
  stage.advance(55ms);
  stage.robot_reports[0].executing(first);
  stage.report(0);
  stage.advance(55ms);
  std::uint64_t expected = 0;
  SECTION("the robot switches to the next version") { stage.robot_reports[0].executing(second); }
  SECTION("the robot switches across several unreported versions") {
    stage.robot_reports[0].executing(third);
  }
  SECTION("the robot switches to a version at rest that does not continue the executed version") {
    // A version at rest on base 0: if reports may have been missed, the robot may have been lifted and put
    // down.
    stage.robot_reports[0].executing(other);
    expected = is_complete ? 1 : 0;
  }
  SECTION("the robot switches to a moving version that does not continue the executed version") {
    stage.advance(10ms);
    stage.robot_reports[0].executing(moved);
    expected = 1;
  }
  SECTION("the robot has already left the new version's base") {
    stage.robot_reports[0].executing(second);
    stage.report(0);
    stage.advance(20ms);
    msg::Version late = stage.next(first, 7, -5ms);
    stage.command(late);
    stage.robot_reports[0].executing(late);
    stage.report(0);
    CHECK(stage.count(AuditRule::kSwitch) == 1);
    return;
  }
  SECTION("the robot switches along unknown versions") {
    msg::Version stranger = stage.next(first, 9, -10ms);
    stranger.base(8);
    stage.command(stranger);
    stage.robot_reports[0].executing(stranger);
    stage.report(0);
    CHECK(stage.count(AuditRule::kSwitch) == 0);
    return;
  }
  stage.report(0);
  check_only(stage, AuditRule::kSwitch, expected);
}

TEST_CASE("a robot that executes an excluded version breaks the rule of the reason for its exclusion") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1, 50ms);
  const msg::Version second = stage.next(stage.rest(0), 2, 60ms);
  for (const auto& version : {first, second}) {
    stage.grant(version);
    stage.command(version);
  }
  AuditRule rule = AuditRule::kFacts;
  SECTION("the version was late") {
    stage.advance(50ms);
    stage.report(0);
    rule = AuditRule::kLateSwitch;
  }
  SECTION("the version was fenced") {
    stage.robot_reports[0].obeyed_incarnation(Stage::kAgent + 1);
    stage.report(0);
    rule = AuditRule::kStaleIncarnation;
    stage.advance(50ms);
  }
  SECTION("the version was older") {
    stage.advance(60ms);
    stage.robot_reports[0].executing(second);
    stage.report(0);
  }
  SECTION("the robot was lifted") {
    stage.advance(50ms);
    msg::Version nothing;
    nothing.base(1);
    stage.robot_reports[0].executing(nothing);
    stage.robot_reports[0].is_lifted(true);
    stage.report(0);
    stage.robot_reports[0].is_lifted(false);
  }
  stage.robot_reports[0].executing(first);
  stage.report(0);
  CHECK(stage.count(rule) == 1);
  CHECK(stage.violations.front().version == 1);
  CHECK(stage.violations.front().epoch == 0);
}

TEST_CASE("the own stop of a robot off its reference must be numbered above the version it replaces") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 5);
  stage.drive(first);
  stage.robot_reports[0].is_off_reference(true);
  std::uint64_t expected = 0;
  VersionNumber number = 6;
  SECTION("the stop is numbered above the version") {}
  SECTION("the stop is numbered below the version") { number = 4, expected = 1; }
  msg::Version stop = stage.next(first, number, 0ms);
  stop.start_ns(to_ns(stage.now));
  stage.robot_reports[0].executing(stop);
  stage.report(0);
  stage.report(0);
  check_only(stage, AuditRule::kOffReference, expected);
}

TEST_CASE("a robot's own stop must brake at D after the motion already under way") {
  const auto [lead, excess, is_reported] = GENERATE(table<Duration, double, bool>({{0ms, 1.0, false},
                                                                                   {0ms, 1.02, true},
                                                                                   {100ms, 1.0, false},
                                                                                   {100ms, 1.05, true},
                                                                                   {-50ms, 1.0, false},
                                                                                   {300ms, 1.0, false},
                                                                                   {400ms, 1.0, true}}));
  CAPTURE(to_seconds(lead), excess);
  Stage stage;
  stage.begin();
  stage.advance(1ms);
  // The motion under way continues at F for the duration of the lead.
  const double lead_s = std::max(0.0, to_seconds(lead)), speed_mps = 1 + 2 * lead_s;
  const double braking_s = speed_mps / stage.scenario.limits.deceleration_mps2 * excess;
  msg::Version stop = stage.next(stage.rest(0), 1, 0ms);
  stop.vx_mps(1);
  stop.phase_count(2);
  stop.phases()[0].duration_ns(std::llround(lead_s * 1e9));
  stop.phases()[0].ax_mps2(2);
  stop.phases()[1].duration_ns(std::llround(braking_s * 1e9));
  stop.phases()[1].ax_mps2(-speed_mps / (static_cast<double>(stop.phases()[1].duration_ns()) * 1e-9));
  stage.robot_reports[0].executing(stop);
  stage.robot_reports[0].is_off_reference(true);
  stage.robot_reports[0].lead_ns(lead.count());
  stage.report(0);
  check_only(stage, AuditRule::kOffReference, is_reported ? 1 : 0);
}

TEST_CASE("a robot's own stop must end at rest") {
  const auto [left_mps, is_reported] = GENERATE(table<double, bool>({{9e-6, false}, {1.2e-5, true}}));
  Stage stage;
  stage.begin();
  msg::Version stop = stage.next(stage.rest(0), 1, 0ms);
  stop.vy_mps(left_mps);
  stage.robot_reports[0].executing(stop);
  stage.robot_reports[0].is_off_reference(true);
  stage.report(0);
  check_only(stage, AuditRule::kOffReference, is_reported ? 1 : 0);
}

TEST_CASE("a version that was sent is not an own stop, even if a robot off its reference executes it") {
  Stage stage;
  stage.begin();
  msg::Version first = stage.next(stage.rest(0), 1);
  stage.grant(first);
  const bool was_sent = GENERATE(true, false);
  CAPTURE(was_sent);
  if (was_sent) stage.command(first);
  stage.now = time_from_ns(first.start_ns());
  stage.robot_reports[0].executing(first);
  stage.robot_reports[0].is_off_reference(true);
  stage.report(0);
  CHECK(stage.violations.empty());
}

/// Reports these errors one after another, a millisecond apart.
void report_errors(Stage& stage, const std::vector<double>& errors_m) {
  for (const double error_m : errors_m) {
    stage.advance(1ms);
    stage.robot_reports[0].tracking_error_m(error_m);
    stage.report(0);
  }
}
std::vector<double> repeated(double error_m, int times) {
  return std::vector<double>(static_cast<std::size_t>(times), error_m);
}

TEST_CASE(
    "a robot must recover beyond the drift bound without moving away, and within 1 ms beyond the tracking "
    "bound") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  const double drift_m = drift_bound_m(stage.scenario.tracking_bound_m) + 0.0005,
               tracking_m = stage.scenario.tracking_bound_m + 0.0005;
  stage.begin();
  bool is_reported = false;
  SECTION("the robot is within the drift bound") { report_errors(stage, repeated(drift_m - 1e-6, 100)); }
  SECTION("the robot is 26 ms beyond the drift bound") { report_errors(stage, repeated(drift_m + 1e-6, 27)); }
  SECTION("the robot is beyond the drift bound for 27 ms and moves away") {
    report_errors(stage, repeated(drift_m + 1e-6, 27));
    report_errors(stage, {drift_m + 0.0005 + 3e-6});
    is_reported = true;
  }
  SECTION("the robot moves away slowly, by less than the tolerance in each report") {
    std::vector<double> errors_m = repeated(drift_m + 1e-6, 27);
    for (int i = 0; i < 20; ++i) errors_m.push_back(errors_m.back() + 0.00004);
    report_errors(stage, errors_m);
    is_reported = true;
  }
  SECTION("the next check of the robot is late, and it does not move away meanwhile") {
    report_errors(stage, repeated(drift_m + 0.0001, 27));
    report_errors(stage, repeated(drift_m + 0.0004, 73));
    report_errors(stage, {0});
  }
  SECTION("the robot never returns") {
    report_errors(stage, repeated(drift_m + 1e-6, 102));
    is_reported = true;
  }
  SECTION("the robot is beyond the drift bound twice for 26 ms") {
    report_errors(stage, repeated(drift_m + 1e-6, 27));
    report_errors(stage, {0});
    report_errors(stage, repeated(drift_m + 1e-6, 27));
  }
  SECTION("the robot is within the tracking bound for 26 ms") {
    report_errors(stage, repeated(tracking_m - 1e-6, 27));
  }
  SECTION("the robot is beyond the tracking bound for a millisecond") {
    report_errors(stage, repeated(tracking_m + 1e-6, 2));
  }
  SECTION("the robot is beyond the tracking bound for longer than a millisecond") {
    report_errors(stage, repeated(tracking_m + 1e-6, 3));
    is_reported = true;
  }
  SECTION("the robot is beyond the tracking bound repeatedly") {
    for (int i = 0; i < 10; ++i) report_errors(stage, {tracking_m + 1e-6, tracking_m + 1e-6, 0});
  }
  SECTION("the robot is beyond the tracking bound, but reports were missed in between") {
    report_errors(stage, repeated(tracking_m + 1e-6, 2));
    (void)stage.header("feedback", 0);
    report_errors(stage, repeated(tracking_m + 1e-6, 2));
  }
  SECTION("the robot is beyond the tracking bound while off its reference or lifted") {
    const bool is_lifted = GENERATE(true, false);
    stage.robot_reports[0].is_off_reference(!is_lifted);
    stage.robot_reports[0].is_lifted(is_lifted);
    report_errors(stage, repeated(1, 50));
  }
  SECTION("the robot is within the drift bound plus its inflation") {
    stage.robot_reports[0].executing().inflation_m(0.02);
    report_errors(stage, repeated(0.02 + drift_m - 1e-6, 100));
    stage.violations.clear();  // the inflation has no base
  }
  SECTION("the robot is beyond the tracking bound plus its inflation") {
    Stage inflated(stage_scenario(), is_complete ? kComplete : kIncomplete);
    inflated.robot_reports[0].executing().inflation_m(0.02);
    inflated.begin();
    report_errors(inflated, repeated(0.02 + tracking_m - 1e-6, 2));
    CHECK(inflated.violations.empty());
    report_errors(inflated, repeated(0.02 + tracking_m + 1e-6, 3));
    CHECK(inflated.count(AuditRule::kTracking) > 0);
  }
  SECTION("the robot's clock is out of bounds") {
    for (int i = 0; i < 50; ++i) {
      stage.advance(1ms);
      stage.robot_reports[0].tracking_error_m(1);
      stage.robot_reports[0].valid_at_ns(to_ns(stage.now) + 50'000'000);
      stage.report(0);
    }
  }
  INFO(stage.lines());
  CHECK((stage.count(AuditRule::kTracking) > 0) == is_reported);
  CHECK(stage.violations.size() == stage.count(AuditRule::kTracking));
}

TEST_CASE("a clock counts as sound if it is ahead or behind by at most its bound") {
  const auto [ahead, is_sound] = GENERATE(table<Duration, bool>(
      {{1ms + 1us, true}, {1ms + 1001ns, false}, {-1ms - 1us, true}, {-1ms - 1001ns, false}}));
  CAPTURE(ahead.count());
  Scenario scenario = stage_scenario();
  scenario.clock_bound_s = 0.001;
  Stage stage(scenario);
  stage.begin();
  // Only reports made by sound clocks show that a robot is beyond the tracking bound.
  for (int i = 0; i < 5; ++i) {
    stage.advance(1ms);
    stage.robot_reports[0].tracking_error_m(1);
    stage.robot_reports[0].valid_at_ns(to_ns(stage.now + ahead));
    stage.report(0);
  }
  CHECK((stage.count(AuditRule::kTracking) > 0) == is_sound);
}

}  // namespace sidestep::auditor_robots_test
