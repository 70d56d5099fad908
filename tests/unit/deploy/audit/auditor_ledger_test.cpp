// SPDX-License-Identifier: Apache-2.0
// Grants and ledger pages, message by message.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_ledger_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("a correct run breaks no rule") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  msg::Version first = stage.rest(0);
  for (VersionNumber number = 1; number < 200; ++number) {
    const msg::Version second = stage.next(first, number);
    stage.grant(second);
    stage.advance(2ms);
    stage.show_page({first, second, stage.rest(1)});
    stage.advance(2ms);
    stage.command(second);
    stage.now = time_from_ns(second.start_ns());
    stage.robot_reports[0].executing(second);
    stage.report(0);
    stage.report(1);
    stage.advance(1ms);
    first = second;
  }
  INFO(stage.lines());
  CHECK(stage.violations.empty());
  const AuditTotals totals = stage.auditor.totals();
  CHECK(totals.invalid == 0);
  CHECK(totals.coverage.messages == 1);
  CHECK(totals.coverage.versions == 1);
  CHECK(totals.coverage.time == 1);
  CHECK(totals.received == 199 * 6 + 4);
}

TEST_CASE("a command with a permanently denied candidate is reported in any order of the messages") {
  using msg::Reason;
  const auto [reason, is_final] = GENERATE(table<Reason, bool>({{Reason::REASON_NOT_CONTINUOUS, true},
                                                                {Reason::REASON_BEYOND_LIMITS, true},
                                                                {Reason::REASON_NOT_AT_REST, true},
                                                                {Reason::REASON_OUTSIDE_FIELD, true},
                                                                {Reason::REASON_OBSTACLE, true},
                                                                {Reason::REASON_CONFLICT, true},
                                                                {Reason::REASON_NOT_EVALUATED, false},
                                                                {Reason::REASON_LEDGER_FULL, false},
                                                                {Reason::REASON_HELD, false},
                                                                {Reason::REASON_BASE_UNKNOWN, false}}));
  CAPTURE(static_cast<int>(reason));
  Stage stage(stage_scenario(), kIncomplete);
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  SECTION("proposal, verdict, command") {
    stage.propose({version});
    stage.decide(0, 3, 0, reason);
    stage.command(version);
  }
  SECTION("verdict, proposal, command") {
    stage.decide(0, 3, 0, reason);
    stage.propose({version});
    stage.command(version);
  }
  SECTION("command, proposal, verdict") {
    stage.command(version);
    stage.propose({version});
    stage.decide(0, 3, 0, reason);
  }
  stage.command(version);
  CHECK(stage.count(AuditRule::kForwarded) == (is_final ? 1 : 0));
  CHECK(stage.violations.size() == stage.count(AuditRule::kForwarded));
}

TEST_CASE("a verdict decides only its own proposal") {
  Stage stage(stage_scenario(), kIncomplete);
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  stage.propose({version, stage.next(stage.rest(0), 4)});
  bool is_denied = false;
  SECTION("another candidate was granted") {
    stage.decide(0, 3, 4);
    is_denied = true;
  }
  SECTION("this candidate was granted") { stage.decide(0, 3, 3); }
  SECTION("another proposal was denied") { stage.decide(0, 2, 0); }
  SECTION("another robot's proposal was denied") { stage.decide(1, 3, 0); }
  SECTION("another agent's proposal with the same number was denied") {
    stage.now += 1ms;
    stage.decide(0, 3, 0);
  }
  SECTION("the proposal was denied in another epoch") {
    ++stage.epoch;
    stage.decide(0, 3, 0);
    --stage.epoch;
  }
  stage.command(version);
  CHECK(stage.count(AuditRule::kForwarded) == (is_denied ? 1 : 0));
}

TEST_CASE("a command with a version that was never granted is reported once if every message is received") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  stage.propose({version});
  stage.command(version);
  stage.command(version);
  CHECK(stage.count(AuditRule::kForwarded) == (is_complete ? 1 : 0));
}

TEST_CASE("a version is granted only once, but its coordinator may repeat the verdict") {
  Stage stage;
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  stage.grant(version);
  SECTION("the verdict is repeated in the same epoch") {
    stage.decide(0, 3, 3);
    CHECK(stage.violations.empty());
  }
  SECTION("the verdict is repeated in another epoch") {
    ++stage.epoch;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.decide(0, 3, 3);
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
  }
}

TEST_CASE("versions are granted in increasing order within each epoch") {
  Stage stage;
  stage.begin();
  stage.grant(stage.next(stage.rest(0), 10));
  SECTION("a lower number is granted") {
    stage.grant(stage.next(stage.rest(0), 4));
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
    stage.grant(stage.next(stage.rest(0), 7));
    CHECK(stage.count(AuditRule::kVersionOrder) == 2);
    stage.grant(stage.next(stage.rest(0), 11));
    CHECK(stage.count(AuditRule::kVersionOrder) == 2);
  }
  SECTION("a higher number is granted") { stage.grant(stage.next(stage.rest(0), 11)); }
  SECTION("a lower number of another robot is granted") { stage.grant(stage.next(stage.rest(1), 4)); }
  SECTION("a lower number in a new epoch and a higher number in the former epoch") {
    ++stage.epoch;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.grant(stage.next(stage.rest(0), 4));
    CHECK(stage.violations.empty());
    // The coordinator of the former epoch does not know yet that it was superseded.
    --stage.epoch;
    stage.grant(stage.next(stage.rest(0), 8));
    ++stage.epoch;
    stage.grant(stage.next(stage.rest(0), 7));
    CHECK(stage.violations.empty());
    stage.grant(stage.next(stage.rest(0), 6));
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
  }
}

TEST_CASE("only candidates of the answered proposal may be granted, and only in its epoch") {
  Stage stage;
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3), other = stage.next(stage.rest(0), 4);
  std::uint64_t expected = 1;
  SECTION("a candidate is granted") {
    stage.propose({version, other});
    stage.decide(0, 3, GENERATE(3u, 4u));
    expected = 0;
  }
  SECTION("a version that is not a candidate is granted") {
    stage.propose({version});
    stage.decide(0, 3, 4);
  }
  SECTION("the proposal is unknown") { stage.decide(0, 3, 3); }
  SECTION("the proposal was made in another epoch") {
    stage.propose({version});
    ++stage.epoch;
    stage.register_versions(0, {stage.rest(0)}), stage.register_versions(1, {stage.rest(1)});
    stage.decide(0, 3, 3);
  }
  SECTION("the proposal was forgotten because of many others") {
    for (VersionNumber number = 3; number < 20; ++number) stage.propose({stage.next(stage.rest(0), number)});
    stage.decide(0, 3, 3);
    expected = 0;
  }
  CHECK(stage.count(AuditRule::kProposed) == expected);
}

TEST_CASE("a grant before a robot has registered is reported once for each unregistered robot") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  for (RobotId robot = 0; robot < 2; ++robot) stage.report(robot);
  std::uint64_t expected = 1;
  SECTION("the robot registered in another epoch") {
    --stage.epoch;
    stage.register_versions(1, {stage.rest(1)});
    ++stage.epoch;
  }
  SECTION("the robot registered no versions") { stage.register_versions(1, {}); }
  SECTION("the robot registered") {
    stage.register_versions(1, {stage.rest(1)});
    expected = 0;
  }
  stage.register_versions(0, {stage.rest(0)});
  stage.advance(1ms);
  stage.grant(stage.next(stage.rest(0), 1));
  stage.grant(stage.next(stage.rest(0), 2));
  CHECK(stage.count(AuditRule::kAllRegistered) == (is_complete ? expected : 0));
  if (is_complete && expected == 1) CHECK(stage.violations.front().robot == 1);
  CHECK(stage.violations.size() == stage.count(AuditRule::kAllRegistered));
}

TEST_CASE("only one run of one coordinator may grant in an epoch") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  stage.grant(stage.next(stage.rest(0), 1));
  SECTION("the same coordinator grants again") {
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 0);
  }
  SECTION("another coordinator grants") {
    ++stage.coordinator;
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 1);
    CHECK(stage.violations.front().robot == 1);
    CHECK(stage.violations.front().version == 2);
    CHECK(stage.violations.front().epoch == stage.epoch);
  }
  SECTION("the same coordinator grants after a restart") {
    ++stage.coordinator_incarnation;
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 1);
  }
  SECTION("another coordinator grants in another epoch") {
    ++stage.epoch;
    ++stage.coordinator;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 0);
  }
  CHECK(stage.violations.size() == stage.count(AuditRule::kSingleCoordinator));
}

TEST_CASE("a ledger page must list exactly what its robots may execute") {
  Stage stage;
  stage.begin();
  const msg::Version granted = stage.next(stage.rest(0), 1), rest = stage.rest(0), other = stage.rest(1);
  stage.grant(granted);
  std::uint64_t expected = 1;
  SECTION("the page lists all versions") {
    stage.show_page({rest, granted, other});
    expected = 0;
  }
  SECTION("each page lists some of the robots") {
    stage.show_page({other});
    stage.show_page({rest, granted});
    expected = 0;
  }
  SECTION("a robot's last version is missing") { stage.show_page({rest, other}); }
  SECTION("a robot's first version is missing") { stage.show_page({granted, other}); }
  SECTION("the last version of the last robot is missing") { stage.show_page({other, rest}); }
  SECTION("the page lists a version that was only proposed") {
    const msg::Version proposed = stage.next(rest, 2);
    stage.propose({proposed});
    stage.show_page({rest, granted, proposed, other});
  }
  SECTION("the page lists an unknown version") { stage.show_page({other, stage.next(other, 9)}); }
  SECTION("a version that a robot report has excluded is missing") {
    stage.command(granted);
    stage.advance(50ms);
    stage.robot_reports[0].executing(granted);
    stage.report(0);
    stage.show_page({granted, other});
    // The coordinator may not have received the report yet.
    stage.show_page({rest, granted, other});
    expected = 0;
  }
  SECTION("the coordinator of the page does not grant in the epoch") {
    ++stage.coordinator_incarnation;
    stage.show_page({rest, other});
    expected = 0;
  }
  SECTION("the page lists versions of an unknown robot") {
    msg::Version stranger = other;
    stranger.robot(GENERATE(2u, 4'000'000'000u));
    stage.show_page({rest, granted, stranger, other});
    CHECK(stage.auditor.totals().invalid == 1);
    expected = 0;
  }
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kLedgerPage) == expected);
  CHECK(stage.violations.size() == stage.count(AuditRule::kLedgerPage));
}

TEST_CASE("a page without an epoch or with too many versions is invalid") {
  Stage stage;
  stage.begin();
  const auto invalid = [&] { return stage.auditor.totals().invalid; };
  stage.show_page(std::vector<msg::Version>(256, stage.rest(0)));
  CHECK(invalid() == 0);
  stage.show_page(std::vector<msg::Version>(257, stage.rest(0)));
  CHECK(invalid() == 1);
  stage.epoch = 0;
  stage.show_page({stage.rest(0)});
  CHECK(invalid() == 2);
}

TEST_CASE("a version whose verdict was missed is judged if a page of its proposal's epoch lists it") {
  Stage stage(stage_scenario(), kIncomplete);
  stage.begin();
  const msg::Version fast = moving(stage.next(stage.rest(0), 1), 100);
  bool is_certain = false;
  SECTION("the version was proposed in the page's epoch") {
    stage.propose({fast});
    is_certain = true;
  }
  SECTION("the version was proposed in another epoch, so it may have been registered") {
    --stage.epoch;
    stage.propose({fast});
    ++stage.epoch;
  }
  SECTION("the version was not proposed") {}
  SECTION("the version was registered") {
    stage.propose({fast});
    stage.register_versions(0, {fast});
  }
  stage.show_page({stage.rest(0), fast, stage.rest(1)});
  stage.show_page({stage.rest(0), fast, stage.rest(1)});
  CHECK((stage.count(AuditRule::kLimits) > 0) == is_certain);
  if (is_certain) CHECK(stage.violations.front().epoch == stage.epoch);
  const std::size_t found = stage.violations.size();
  // The late verdict is not a second grant.
  stage.decide(0, 1, 1);
  CHECK(stage.count(AuditRule::kVersionOrder) == 0);
  if (is_certain) CHECK(stage.violations.size() == found);
}

TEST_CASE("no version is granted to a held robot except the place where it is put down") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  const auto remember = [&] {
    stage.advance(1ms);
    msg::OrderMemory memory;
    memory.header(stage.header("memory", Stage::kCoordinator));
    memory.process(Stage::kCoordinator);
    memory.page_count(1);
    memory.order_count(1);
    memory.orders()[0].robot(0);
    memory.orders()[0].client(1'000'001);
    memory.orders()[0].terms().order_kind(msg::OrderKind::ORDER_HOLD);
    memory.orders()[0].terms().order_number(100);
    stage.auditor.on_order_memory(memory, stage.now);
    stage.advance(1ms);
  };
  remember();
  const std::int64_t announced_ns = to_ns(stage.now) - 1'000'000;
  bool is_place = false, is_late = true;
  msg::Version version = stage.next(stage.rest(0), 1, 2001ms);
  SECTION("the version moves") { version = moving(version, 0.1); }
  SECTION("the version is the robot's new place") { is_place = true; }
  SECTION("the version rests on another base") { version.base(9); }
  SECTION("the version starts so soon that it may have been granted before the hold") {
    version = moving(version, 0.1);
    version.start_ns(announced_ns + 2'000'000'000);
    is_late = false;
  }
  stage.grant(version);
  remember();
  CHECK(stage.count(AuditRule::kHeld) == (!is_place && (is_late || is_complete) ? 1 : 0));
}

}  // namespace sidestep::auditor_ledger_test
