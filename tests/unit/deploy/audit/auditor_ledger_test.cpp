// SPDX-License-Identifier: Apache-2.0
// Grants and pages of the ledger, message by message.
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

TEST_CASE("a command with a candidate that was denied for good is reported, whichever came first") {
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

TEST_CASE("a verdict decides its own proposal only") {
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
  SECTION("another agent's proposal with the number was denied") {
    stage.now += 1ms;
    stage.decide(0, 3, 0);
  }
  SECTION("it was denied in another epoch") {
    ++stage.epoch;
    stage.decide(0, 3, 0);
    --stage.epoch;
  }
  stage.command(version);
  CHECK(stage.count(AuditRule::kForwarded) == (is_denied ? 1 : 0));
}

TEST_CASE("a command with a version that nobody granted is reported once if every message is received") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  stage.propose({version});
  stage.command(version);
  stage.command(version);
  CHECK(stage.count(AuditRule::kForwarded) == (is_complete ? 1 : 0));
}

TEST_CASE("a version is granted once, except that its coordinator may repeat itself") {
  Stage stage;
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3);
  stage.grant(version);
  SECTION("in the same epoch") {
    stage.decide(0, 3, 3);
    CHECK(stage.violations.empty());
  }
  SECTION("in another epoch") {
    ++stage.epoch;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.decide(0, 3, 3);
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
  }
}

TEST_CASE("versions are granted in increasing order in each epoch") {
  Stage stage;
  stage.begin();
  stage.grant(stage.next(stage.rest(0), 10));
  SECTION("a lower number") {
    stage.grant(stage.next(stage.rest(0), 4));
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
    stage.grant(stage.next(stage.rest(0), 7));
    CHECK(stage.count(AuditRule::kVersionOrder) == 2);
    stage.grant(stage.next(stage.rest(0), 11));
    CHECK(stage.count(AuditRule::kVersionOrder) == 2);
  }
  SECTION("a higher number") { stage.grant(stage.next(stage.rest(0), 11)); }
  SECTION("a lower number of another robot") { stage.grant(stage.next(stage.rest(1), 4)); }
  SECTION("a lower number in a new epoch, and a higher one in the former epoch") {
    ++stage.epoch;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.grant(stage.next(stage.rest(0), 4));
    CHECK(stage.violations.empty());
    // A coordinator that does not know yet that it was superseded.
    --stage.epoch;
    stage.grant(stage.next(stage.rest(0), 8));
    ++stage.epoch;
    stage.grant(stage.next(stage.rest(0), 7));
    CHECK(stage.violations.empty());
    stage.grant(stage.next(stage.rest(0), 6));
    CHECK(stage.count(AuditRule::kVersionOrder) == 1);
  }
}

TEST_CASE("only candidates of the proposal that is answered are granted, in its epoch") {
  Stage stage;
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 3), other = stage.next(stage.rest(0), 4);
  std::uint64_t expected = 1;
  SECTION("a candidate") {
    stage.propose({version, other});
    stage.decide(0, 3, GENERATE(3u, 4u));
    expected = 0;
  }
  SECTION("no candidate") {
    stage.propose({version});
    stage.decide(0, 3, 4);
  }
  SECTION("an unknown proposal") { stage.decide(0, 3, 3); }
  SECTION("a proposal in another epoch") {
    stage.propose({version});
    ++stage.epoch;
    stage.register_versions(0, {stage.rest(0)}), stage.register_versions(1, {stage.rest(1)});
    stage.decide(0, 3, 3);
  }
  SECTION("a proposal that was forgotten because of many others") {
    for (VersionNumber number = 3; number < 20; ++number) stage.propose({stage.next(stage.rest(0), number)});
    stage.decide(0, 3, 3);
    expected = 0;
  }
  CHECK(stage.count(AuditRule::kProposed) == expected);
}

TEST_CASE("a grant before a robot has registered is reported once for each such robot") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  for (RobotId robot = 0; robot < 2; ++robot) stage.report(robot);
  std::uint64_t expected = 1;
  SECTION("it registered in another epoch") {
    --stage.epoch;
    stage.register_versions(1, {stage.rest(1)});
    ++stage.epoch;
  }
  SECTION("it registered nothing") { stage.register_versions(1, {}); }
  SECTION("it registered") {
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

TEST_CASE("only one run of one coordinator grants in an epoch") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  stage.grant(stage.next(stage.rest(0), 1));
  SECTION("the same one") {
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 0);
  }
  SECTION("another one") {
    ++stage.coordinator;
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 1);
    CHECK(stage.violations.front().robot == 1);
    CHECK(stage.violations.front().version == 2);
    CHECK(stage.violations.front().epoch == stage.epoch);
  }
  SECTION("the same one after a restart") {
    ++stage.coordinator_incarnation;
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 1);
  }
  SECTION("another one in another epoch") {
    ++stage.epoch;
    ++stage.coordinator;
    stage.robot_reports[0].obeyed_epoch(stage.epoch), stage.robot_reports[1].obeyed_epoch(stage.epoch);
    stage.begin();
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 0);
  }
  CHECK(stage.violations.size() == stage.count(AuditRule::kSingleCoordinator));
}

TEST_CASE("a page lists what its robots may execute, and nothing else") {
  Stage stage;
  stage.begin();
  const msg::Version granted = stage.next(stage.rest(0), 1), rest = stage.rest(0), other = stage.rest(1);
  stage.grant(granted);
  std::uint64_t expected = 1;
  SECTION("all versions") {
    stage.show_page({rest, granted, other});
    expected = 0;
  }
  SECTION("of some robots only") {
    stage.show_page({other});
    stage.show_page({rest, granted});
    expected = 0;
  }
  SECTION("not the last one") { stage.show_page({rest, other}); }
  SECTION("not the first one") { stage.show_page({granted, other}); }
  SECTION("not the last one of the last robot") { stage.show_page({other, rest}); }
  SECTION("one that was proposed") {
    const msg::Version proposed = stage.next(rest, 2);
    stage.propose({proposed});
    stage.show_page({rest, granted, proposed, other});
  }
  SECTION("one that nobody knows") { stage.show_page({other, stage.next(other, 9)}); }
  SECTION("none that a fact has excluded") {
    stage.command(granted);
    stage.advance(50ms);
    stage.robot_reports[0].executing(granted);
    stage.report(0);
    stage.show_page({granted, other});
    // It may be behind.
    stage.show_page({rest, granted, other});
    expected = 0;
  }
  SECTION("a page of a coordinator that does not grant in the epoch") {
    ++stage.coordinator_incarnation;
    stage.show_page({rest, other});
    expected = 0;
  }
  SECTION("versions of no robot") {
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

TEST_CASE("a page is invalid without an epoch, or with more versions than a page has") {
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

TEST_CASE("a version whose verdict was missed is judged if a page of the epoch of its proposal lists it") {
  Stage stage(stage_scenario(), kIncomplete);
  stage.begin();
  const msg::Version fast = moving(stage.next(stage.rest(0), 1), 100);
  bool is_certain = false;
  SECTION("proposed") {
    stage.propose({fast});
    is_certain = true;
  }
  SECTION("proposed in another epoch, so that it may have been registered") {
    --stage.epoch;
    stage.propose({fast});
    ++stage.epoch;
  }
  SECTION("not proposed") {}
  SECTION("registered") {
    stage.propose({fast});
    stage.register_versions(0, {fast});
  }
  stage.show_page({stage.rest(0), fast, stage.rest(1)});
  stage.show_page({stage.rest(0), fast, stage.rest(1)});
  CHECK((stage.count(AuditRule::kLimits) > 0) == is_certain);
  if (is_certain) CHECK(stage.violations.front().epoch == stage.epoch);
  const std::size_t found = stage.violations.size();
  // The verdict is not another grant.
  stage.decide(0, 1, 1);
  CHECK(stage.count(AuditRule::kVersionOrder) == 0);
  if (is_certain) CHECK(stage.violations.size() == found);
}

TEST_CASE("nothing is granted to a held robot, except the place where it is put down") {
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
  const std::int64_t told_ns = to_ns(stage.now) - 1'000'000;
  bool is_place = false, is_late = true;
  msg::Version version = stage.next(stage.rest(0), 1, 2001ms);
  SECTION("a version that moves") { version = moving(version, 0.1); }
  SECTION("a place") { is_place = true; }
  SECTION("a rest on another base") { version.base(9); }
  SECTION("a version that starts so soon that it may have been granted before the hold") {
    version = moving(version, 0.1);
    version.start_ns(told_ns + 2'000'000'000);
    is_late = false;
  }
  stage.grant(version);
  remember();
  CHECK(stage.count(AuditRule::kHeld) == (!is_place && (is_late || is_complete) ? 1 : 0));
}

}  // namespace sidestep::auditor_ledger_test
