// SPDX-License-Identifier: Apache-2.0
// Grants and pages of the ledger, message by message.
#include <algorithm>

#include "tests/catch.hpp"
#include "tests/unit/deploy/monitor/audit/stage.hpp"

namespace sidestep::auditor_ledger_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

/// Drives at this speed along x at once, and brakes after a second.
msg::Version moving(msg::Version version, double speed_mps) {
  version.phase_count(2);
  version.phases()[0].duration_ns(1'000'000'000);
  version.phases()[0].ax_mps2(speed_mps);
  version.phases()[1].duration_ns(1'000'000'000);
  version.phases()[1].ax_mps2(-speed_mps);
  return version;
}

TEST_CASE("a run in which everything is as it should be breaks no rule") {
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
    stage.facts[0].executing(second);
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
    stage.facts[0].obeyed_epoch(stage.epoch), stage.facts[1].obeyed_epoch(stage.epoch);
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
    stage.facts[0].obeyed_epoch(stage.epoch), stage.facts[1].obeyed_epoch(stage.epoch);
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

TEST_CASE("one run of one coordinator grants in an epoch") {
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
    ++stage.coordinator_life;
    stage.grant(stage.next(stage.rest(1), 2));
    CHECK(stage.count(AuditRule::kSingleCoordinator) == 1);
  }
  SECTION("another one in another epoch") {
    ++stage.epoch;
    ++stage.coordinator;
    stage.facts[0].obeyed_epoch(stage.epoch), stage.facts[1].obeyed_epoch(stage.epoch);
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
    stage.facts[0].executing(granted);
    stage.report(0);
    stage.show_page({granted, other});
    // It may be behind.
    stage.show_page({rest, granted, other});
    expected = 0;
  }
  SECTION("a page of a coordinator that does not grant in the epoch") {
    ++stage.coordinator_life;
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

/// Two robots 0.21 m apart. Version 1 of robot 0 comes 0.05 m nearer, which is too close.
struct Narrow : Stage {
  static Scenario narrow() {
    Scenario scenario = stage_scenario();
    scenario.robots[0].start_m = {-0.105, 0};
    scenario.robots[1].start_m = {0.105, 0};
    return scenario;
  }
  explicit Narrow(const AuditInput& input) : Stage(narrow(), input) {
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

TEST_CASE("a version that comes too close to what is registered is reported when it is granted") {
  const bool is_other_first = GENERATE(true, false);
  Narrow narrow(kComplete);
  if (is_other_first) narrow.report(1);
  narrow.grant(narrow.closer);
  REQUIRE(narrow.too_close() == 0);  // no fact after the grant shows that it was still possible
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
  CHECK(narrow.violations.size() == 1);
}

TEST_CASE("a verdict that is repeated does not make the grant later") {
  Narrow narrow(kComplete);
  narrow.grant(narrow.closer);
  narrow.advance(1ms);
  narrow.report(1);
  narrow.advance(1ms);
  narrow.decide(0, 1, 1);
  narrow.report(0);
  CHECK(narrow.too_close() == 1);
}

TEST_CASE("a version is compared for a while after a fact has excluded it, because other facts come later") {
  Narrow narrow(kComplete);
  narrow.grant(narrow.closer);
  narrow.report(0);
  narrow.facts[0].executing(narrow.next(narrow.rest(0), 9, -1ms));
  for (int i = 0; i < 5; ++i) {
    narrow.report(0);
    narrow.advance(9ms);
  }
  CHECK(narrow.too_close() == 0);
  narrow.report(1);
  CHECK(narrow.too_close() == 1);
}

TEST_CASE("a robot's own stop is not compared, except with what is granted after a page has listed it") {
  const bool is_listed = GENERATE(true, false);
  Narrow narrow(kComplete);
  msg::Version stop = moving(narrow.next(narrow.rest(0), 1, 0ms), 0.01);
  narrow.facts[0].executing(stop);
  narrow.facts[0].is_off_reference(true);
  narrow.report(0);
  narrow.violations.clear();  // it does not brake
  const msg::Version version = moving(narrow.next(narrow.rest(1), 2), -0.01);
  if (!is_listed) narrow.grant(version);
  narrow.page({stop, narrow.rest(1)});
  narrow.violations.clear();  // without the version
  if (is_listed) narrow.grant(version);
  for (int i = 0; i < 3; ++i) {
    narrow.advance(5ms);
    narrow.report(0);
    narrow.report(1);
  }
  INFO(narrow.lines());
  CHECK(narrow.too_close() == (is_listed ? 1 : 0));
}

TEST_CASE("a robot's own stop that comes too close is no violation") {
  Narrow narrow(kComplete);
  msg::Version stop = moving(narrow.next(narrow.rest(0), 1, 0ms), 0.05);
  narrow.facts[0].executing(stop);
  narrow.facts[0].is_off_reference(true);
  for (int i = 0; i < 5; ++i) {
    narrow.report(0);
    narrow.page({stop, narrow.rest(1)});
    narrow.report(1);
  }
  CHECK(narrow.too_close() == 0);
}

TEST_CASE("versions with much inflation conflict far away") {
  Stage stage;
  for (msg::Feedback& fact : stage.facts) fact.executing().inflation_m(0.4);
  stage.begin();
  msg::Version version = moving(stage.next(stage.facts[0].executing(), 1), 1.01);
  version.inflation_m(0.4);
  stage.grant(version);
  stage.advance(1ms);
  stage.report(0);
  stage.report(1);
  CHECK(stage.count(AuditRule::kClearance) == 1);
}

TEST_CASE("versions that were forgotten because of many others break no rule") {
  Stage stage;
  stage.begin();
  const VersionNumber first = 10, count = 70;
  for (VersionNumber number = first; number < first + count; ++number)
    stage.grant(stage.next(stage.rest(0), number, 1s));
  REQUIRE(stage.violations.empty());
  // The rest and the first versions are forgotten: 64 remain.
  const VersionNumber forgotten = first + count - 64 - 1;
  SECTION("a command with the last one that is forgotten") {
    stage.command(stage.next(stage.rest(0), forgotten, 1s));
  }
  SECTION("a command with the first one that is not") {
    stage.command(stage.next(stage.rest(0), forgotten + 1, 1s));
  }
  SECTION("a command with one that was never granted") {
    stage.command(stage.next(stage.rest(0), first + count, 1s));
    CHECK(stage.count(AuditRule::kForwarded) == 1);
    return;
  }
  SECTION("a repeated verdict") { stage.decide(0, forgotten, forgotten); }
  SECTION("a page") {
    stage.show_page({stage.next(stage.rest(0), forgotten, 1s)});
    stage.violations.clear();
  }
  INFO(stage.lines());
  CHECK(stage.violations.empty());
}

TEST_CASE("of many violations the first twenty are kept, and all are counted") {
  Stage stage;
  stage.begin();
  for (VersionNumber number = 1; number <= 30; ++number) {
    stage.decide(0, number, number);  // nobody has proposed it
  }
  CHECK(stage.violations.size() >= 30);
  const AuditTotals totals = stage.auditor.totals();
  CHECK(totals.first.size() == 20);
  CHECK(totals.violations == stage.violations.size());
}

TEST_CASE("pages prove that the ledger held a registered version before it granted another one") {
  Narrow narrow(kIncomplete);
  const std::vector<msg::Version> before{narrow.rest(0), narrow.rest(1)},
      after{narrow.rest(0), narrow.closer, narrow.rest(1)};
  std::uint64_t expected = 0;
  SECTION("both pages") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    narrow.page(after);
    expected = 1;
  }
  SECTION("both pages, verdict last") {
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
  SECTION("no page before the grant") {
    narrow.grant(narrow.closer);
    narrow.page(after);
    narrow.page(after);
  }
  SECTION("the page before does not list the registered version") {
    narrow.page({narrow.rest(0)});
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the page before does not list the other robot") {
    narrow.page({narrow.rest(1)});
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("the page before is of another epoch") {
    --narrow.epoch;
    narrow.page(before);
    ++narrow.epoch;
    narrow.grant(narrow.closer);
    narrow.page(after);
  }
  SECTION("no page after the grant") {
    narrow.page(before);
    narrow.grant(narrow.closer);
  }
  SECTION("the page after does not list the registered version") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    narrow.page({narrow.rest(0), narrow.closer});
  }
  SECTION("the page after is of another run of the coordinator") {
    narrow.page(before);
    narrow.grant(narrow.closer);
    ++narrow.coordinator_life;
    narrow.page(after);
  }
  SECTION("the pages are of another run than the grant") {
    ++narrow.coordinator_life;
    narrow.page(before);
    --narrow.coordinator_life;
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
  SECTION("the pages came to be in the other order") {
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
  Narrow narrow(kIncomplete);
  const msg::Version rest = narrow.rest(0), other_rest = narrow.rest(1);
  const msg::Version version = moving(narrow.next(rest, 1), 0.01);
  const msg::Version other = moving(narrow.next(other_rest, 2), -0.01);
  narrow.grant(version);
  narrow.grant(other);
  std::uint64_t expected = 1;
  SECTION("on one page") { narrow.page({rest, version, other_rest, other}); }
  SECTION("on two pages") {
    narrow.page({rest, version});
    narrow.page({other_rest, other});
  }
  SECTION("on two pages in the other order") {
    narrow.page({other_rest, other});
    narrow.page({rest, version});
  }
  SECTION("only one of them") {
    narrow.page({rest, other_rest, other});
    expected = 0;
  }
  SECTION("one of them in another epoch") {
    narrow.page({rest, version});
    ++narrow.epoch;
    narrow.page({other_rest, other});
    expected = 0;
  }
  narrow.page({rest, other_rest});
  CHECK(narrow.too_close() == expected);
  CHECK(narrow.violations.size() == expected);
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
