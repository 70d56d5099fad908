// SPDX-License-Identifier: Apache-2.0
// Which messages prove that versions of two robots are too close.
#include <algorithm>
#include <cstdio>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_proofs_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

/// Two robots 0.21 m apart. Version 1 of robot 0 comes 0.05 m nearer, which is too close.
struct CloseRobotsStage : Stage {
  static Scenario narrow() {
    Scenario scenario = stage_scenario();
    scenario.robots[0].start_m = {-0.105, 0};
    scenario.robots[1].start_m = {0.105, 0};
    return scenario;
  }
  explicit CloseRobotsStage(const AuditInput& input) : Stage(narrow(), input) {
    begin();
    closer = moving(next(rest(0), 1), 0.05);
  }
  void page(const std::vector<msg::Version>& versions) {
    advance(1ms);
    show_page(versions);
    advance(1ms);
  }
  std::uint64_t too_close() const { return count(AuditRule::kClearance); }

  msg::Version closer;
};

TEST_CASE("a version that comes too close to a registered version is reported when it is granted") {
  const bool is_other_first = GENERATE(true, false);
  CloseRobotsStage narrow(kComplete);
  if (is_other_first) narrow.report(1);
  narrow.grant(narrow.closer);
  REQUIRE(narrow.too_close() == 0);  // no later report proves an overlap
  narrow.advance(1ms);
  narrow.report(0);
  narrow.report(1);
  narrow.report(0);
  REQUIRE(narrow.too_close() == 1);
  const Violation& found = narrow.violations.front();
  CHECK(std::min(found.robot, *found.other) == 0);
  CHECK(std::max(found.robot, *found.other) == 1);
  CHECK(found.version + found.other_version == 1);
  CHECK(found.epoch == narrow.epoch);
  double distance_m = 0, at_s = 0, required_m = 0;
  REQUIRE(std::sscanf(found.detail.c_str(), "%lf m apart at %lf s, %lf m required", &distance_m, &at_s,
                      &required_m) == 3);
  CHECK(distance_m == Approx(0.16));
  CHECK(at_s == Approx(1e-9 * static_cast<double>(narrow.closer.start_ns()) + 2).margin(0.1));
  CHECK(required_m == Approx(2 * narrow.scenario.radius_m + narrow.scenario.margin_m));
  CHECK(narrow.violations.size() == 1);
}

TEST_CASE("repeating a verdict does not change the time of the grant") {
  CloseRobotsStage narrow(kComplete);
  narrow.grant(narrow.closer);
  narrow.advance(1ms);
  narrow.report(1);
  narrow.advance(1ms);
  narrow.decide(0, 1, 1);
  narrow.report(0);
  CHECK(narrow.too_close() == 1);
}

TEST_CASE("an excluded version is still compared with versions whose reports arrive soon afterwards") {
  CloseRobotsStage narrow(kComplete);
  narrow.grant(narrow.closer);
  narrow.report(0);
  narrow.robot_reports[0].executing(narrow.next(narrow.rest(0), 9, -1ms));
  for (int i = 0; i < 5; ++i) {
    narrow.report(0);
    narrow.advance(9ms);
  }
  CHECK(narrow.too_close() == 0);
  narrow.report(1);
  CHECK(narrow.too_close() == 1);
}

TEST_CASE("a robot's own stop is compared only with versions granted after a page has listed it") {
  const bool is_listed = GENERATE(true, false);
  CloseRobotsStage narrow(kComplete);
  msg::Version stop = moving(narrow.next(narrow.rest(0), 1, 0ms), 0.01);
  narrow.robot_reports[0].executing(stop);
  narrow.robot_reports[0].is_off_reference(true);
  narrow.report(0);
  narrow.violations.clear();  // reported because the stop does not brake
  const msg::Version version = moving(narrow.next(narrow.rest(1), 2), -0.01);
  if (!is_listed) narrow.grant(version);
  narrow.page({stop, narrow.rest(1)});
  narrow.violations.clear();  // reported because the page lacks `version`
  if (is_listed) narrow.grant(version);
  for (int i = 0; i < 3; ++i) {
    narrow.advance(5ms);
    narrow.report(0);
    narrow.report(1);
  }
  INFO(narrow.lines());
  CHECK(narrow.too_close() == (is_listed ? 1 : 0));
}

TEST_CASE("a robot's own stop that comes too close is not a violation") {
  CloseRobotsStage narrow(kComplete);
  msg::Version stop = moving(narrow.next(narrow.rest(0), 1, 0ms), 0.05);
  narrow.robot_reports[0].executing(stop);
  narrow.robot_reports[0].is_off_reference(true);
  for (int i = 0; i < 5; ++i) {
    narrow.report(0);
    narrow.page({stop, narrow.rest(1)});
    narrow.report(1);
  }
  CHECK(narrow.too_close() == 0);
}

TEST_CASE("versions with large inflations conflict even if they are far apart") {
  Stage stage;
  for (msg::Feedback& robot_report : stage.robot_reports) robot_report.executing().inflation_m(0.4);
  stage.begin();
  msg::Version version = moving(stage.next(stage.robot_reports[0].executing(), 1), 1.01);
  version.inflation_m(0.4);
  stage.grant(version);
  stage.advance(1ms);
  stage.report(0);
  stage.report(1);
  CHECK(stage.count(AuditRule::kClearance) == 1);
}

TEST_CASE("forgotten versions break no rule") {
  Stage stage;
  stage.begin();
  const VersionNumber first = 10, count = 70;
  for (VersionNumber number = first; number < first + count; ++number)
    stage.grant(stage.next(stage.rest(0), number, 1s));
  REQUIRE(stage.violations.empty());
  // The initial rest and the lowest versions are forgotten: 64 versions remain.
  const VersionNumber forgotten = first + count - 64 - 1;
  SECTION("a command contains the last forgotten version") {
    stage.command(stage.next(stage.rest(0), forgotten, 1s));
  }
  SECTION("a command contains the first version that is not forgotten") {
    stage.command(stage.next(stage.rest(0), forgotten + 1, 1s));
  }
  SECTION("a command contains a version that was never granted") {
    stage.command(stage.next(stage.rest(0), first + count, 1s));
    CHECK(stage.count(AuditRule::kForwarded) == 1);
    return;
  }
  SECTION("a verdict is repeated") { stage.decide(0, forgotten, forgotten); }
  SECTION("a page lists a forgotten version") {
    stage.show_page({stage.next(stage.rest(0), forgotten, 1s)});
    stage.violations.clear();
  }
  INFO(stage.lines());
  CHECK(stage.violations.empty());
}

TEST_CASE("the first twenty of many violations are kept, and all are counted") {
  Stage stage;
  stage.begin();
  for (VersionNumber number = 1; number <= 30; ++number) {
    stage.decide(0, number, number);  // grants a version that was not proposed
  }
  CHECK(stage.violations.size() >= 30);
  const AuditTotals totals = stage.auditor.totals();
  CHECK(totals.first.size() == 20);
  CHECK(totals.violations == stage.violations.size());
}

TEST_CASE("two granted versions that are too close together are reported even before they are executed") {
  CloseRobotsStage narrow(kComplete);
  narrow.grant(moving(narrow.next(narrow.rest(0), 1), 0.01));
  narrow.grant(moving(narrow.next(narrow.rest(1), 2), -0.01));
  narrow.advance(1ms);
  narrow.report(0);
  narrow.report(1);
  CHECK(narrow.too_close() == 1);
  CHECK(narrow.violations.size() == 1);
}

TEST_CASE("times of two robots are compared only while both clocks are within bounds") {
  const bool is_sound = GENERATE(true, false);
  const RobotId first = GENERATE(RobotId{0}, RobotId{1});
  CAPTURE(is_sound, first);
  CloseRobotsStage narrow(kComplete);
  narrow.command(narrow.closer);
  narrow.now = time_from_ns(narrow.closer.start_ns());
  narrow.robot_reports[0].executing(narrow.closer);
  narrow.report(0);
  narrow.report(1);
  narrow.advance(500ms);
  // Reports prove which versions the first robot has executed. Then its clock jumps.
  narrow.report(first);
  msg::Feedback late = narrow.robot_reports[first];
  narrow.advance(1ms);
  if (!is_sound) late.valid_at_ns(to_ns(narrow.now + 1s));
  narrow.report(late);
  narrow.advance(1ms);
  narrow.report(1 - first);
  CHECK(narrow.too_close() == (is_sound ? 1 : 0));
}

TEST_CASE("pages before and after a grant prove that the ledger held a registered version at the grant") {
  CloseRobotsStage narrow(kIncomplete);
  const std::vector<msg::Version> before{narrow.rest(0), narrow.rest(1)},
      after{narrow.rest(0), narrow.closer, narrow.rest(1)};
  std::uint64_t expected = 0;
  SECTION("both pages are received") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    narrow.page(after);
    expected = 1;
  }
  SECTION("both pages are received before the verdict") {
    narrow.page(before);
    narrow.propose({narrow.closer});
    const Time proposed_at = narrow.now;
    narrow.advance(1ms);
    narrow.page(after);
    msg::Verdict verdict;
    verdict.robot(0);
    verdict.header(narrow.header("verdict", Stage::kCoordinator));
    verdict.header().stamp_ns(to_ns(proposed_at));
    verdict.epoch(narrow.epoch);
    verdict.proposal_number(1);
    verdict.request_stamp_ns(to_ns(proposed_at));
    verdict.granted_version(1);
    narrow.auditor.on_verdict(verdict, narrow.now);
    expected = 1;
  }
  SECTION("no page before the grant is received") {
    narrow.grant(narrow.closer);
    narrow.page(after);
    narrow.page(after);
  }
  SECTION("the page before the grant does not list the registered version") {
    narrow.page({narrow.rest(0)});
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the page before the grant does not list the other robot") {
    narrow.page({narrow.rest(1)});
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the page before the grant lists an unknown robot instead of the other robot") {
    msg::Version stranger = narrow.rest(1);
    stranger.robot(77);
    narrow.page({narrow.rest(1), stranger});
    CHECK(narrow.auditor.totals().invalid == 1);
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the page before the grant belongs to another epoch") {
    --narrow.epoch;
    narrow.page(before);
    ++narrow.epoch;
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("no page after the grant is received") {
    narrow.page(before);
    narrow.grant(narrow.closer);
  }
  SECTION("the page after the grant does not list the registered version") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    narrow.page({narrow.rest(0), narrow.closer});
  }
  SECTION("the page after the grant belongs to another run of the coordinator") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    ++narrow.coordinator_incarnation;
    narrow.page(after);
  }
  SECTION("the pages belong to a different run of the coordinator than the grant") {
    ++narrow.coordinator_incarnation;
    narrow.page(before);
    --narrow.coordinator_incarnation;
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the coordinator's clock was set back") {
    narrow.page(before);
    narrow.now -= 10ms;
    narrow.page(before);
    narrow.now += 20ms;
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the pages were made in reverse order") {
    narrow.grant(narrow.closer);
    narrow.advance(10ms);
    narrow.page(after);
    msg::LedgerPage late;
    late.header(narrow.header("ledger", Stage::kCoordinator));
    late.header().message_number(0);
    late.header().stamp_ns(to_ns(narrow.now - 5ms));
    late.epoch(narrow.epoch);
    late.versions(before);
    narrow.auditor.on_ledger(late, narrow.now);
    narrow.page(after);
  }
  narrow.report(0);
  narrow.report(1);
  INFO(narrow.lines());
  CHECK(narrow.too_close() == expected);
  CHECK(narrow.violations.size() == expected);
}

TEST_CASE("two granted versions that are too close together are reported, whichever pages list them first") {
  CloseRobotsStage narrow(kIncomplete);
  const msg::Version rest = narrow.rest(0), other_rest = narrow.rest(1);
  const msg::Version version = moving(narrow.next(rest, 1), 0.01);
  const msg::Version other = moving(narrow.next(other_rest, 2), -0.01);
  narrow.grant(version);
  narrow.grant(other);
  std::uint64_t expected = 1;
  SECTION("one page lists both versions") { narrow.page({rest, version, other_rest, other}); }
  SECTION("two pages list one version each") {
    narrow.page({rest, version});
    narrow.page({other_rest, other});
  }
  SECTION("two pages list one version each, in reverse order") {
    narrow.page({other_rest, other});
    narrow.page({rest, version});
  }
  SECTION("only one version is listed on a page") {
    narrow.page({rest, other_rest, other});
    expected = 0;
  }
  SECTION("one version is listed on a page of another epoch") {
    narrow.page({rest, version});
    ++narrow.epoch;
    narrow.page({other_rest, other});
    expected = 0;
  }
  narrow.page({rest, other_rest});
  CHECK(narrow.too_close() == expected);
  CHECK(narrow.violations.size() == expected);
}

}  // namespace sidestep::auditor_proofs_test
