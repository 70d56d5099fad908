// SPDX-License-Identifier: Apache-2.0
// Versions that the auditor evicted long after a report of their robot had excluded them. A coordinator that
// hears no reports still lists them, and an agent that does not hear its robot still registers them.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_evicted_test {

using namespace std::chrono_literals;

constexpr VersionNumber kOwnStop = 1'000'000;

void begin_next_epoch(Stage& stage) {
  ++stage.epoch;
  for (msg::Feedback& robot_report : stage.robot_reports) robot_report.obeyed_epoch(stage.epoch);
  stage.begin();
}

/// Lets the auditor evict all versions that robot 0's reports have excluded so far.
void evict_excluded(Stage& stage) {
  stage.advance(1501ms);
  stage.report(0);
}

/// The coordinator of epoch 5, which hears no reports, lists a version of robot 0.
void list_late(Stage& stage, const msg::Version& version) {
  stage.epoch = 5;
  stage.show_page({version, stage.rest(1)});
}

void check_no_violation(const Stage& stage) {
  INFO(stage.lines());
  CHECK(stage.violations.empty());
}

/// Robot 0 is granted version 1 in epoch 5. In epoch 6 it replaces this version by its own stop.
struct StoppedStage : Stage {
  StoppedStage() {
    begin();
    granted = next(rest(0), 1);
    drive(granted);
    begin_next_epoch(*this);
    own_stop = next(granted, kOwnStop, 0ms);
    robot_reports[0].executing(own_stop);
    robot_reports[0].is_off_reference(true);
    report(0);
    evict_excluded(*this);
  }

  msg::Version granted, own_stop;
};

TEST_CASE("an old coordinator may list an evicted version, whether or not its agent registers it again") {
  StoppedStage stage;
  if (GENERATE(true, false)) stage.register_versions(0, {stage.granted});
  list_late(stage, stage.granted);
  check_no_violation(stage);
}

TEST_CASE("an old coordinator may list an evicted own stop that an agent registers again") {
  StoppedStage stage;
  stage.robot_reports[0].is_off_reference(false);
  stage.drive(stage.next(stage.own_stop, kOwnStop + 1));
  evict_excluded(stage);
  stage.register_versions(0, {stage.own_stop});
  list_late(stage, stage.own_stop);
  check_no_violation(stage);
}

TEST_CASE("an old coordinator may list an evicted initial rest that an agent registers again") {
  Stage stage;
  stage.begin();
  begin_next_epoch(stage);
  stage.drive(stage.next(stage.rest(0), 1));
  evict_excluded(stage);
  stage.register_versions(0, {stage.rest(0)});
  list_late(stage, stage.rest(0));
  check_no_violation(stage);
}

TEST_CASE("an old coordinator may repeat a grant of, or grant on, an evicted version registered again") {
  StoppedStage stage;
  stage.register_versions(0, {stage.granted});
  stage.epoch = 5;
  SECTION("a repeated grant") { stage.decide(0, 1, 1); }
  SECTION("a grant on this base") { stage.grant(stage.next(stage.granted, 2)); }
  check_no_violation(stage);
}

TEST_CASE("a version that is numbered above all evicted ones is not taken for an evicted one") {
  StoppedStage stage;
  const msg::Version unknown = stage.next(stage.own_stop, kOwnStop + 1);
  if (GENERATE(true, false)) stage.register_versions(0, {unknown});
  list_late(stage, unknown);
  check_only(stage, AuditRule::kLedgerPage, 1);
}

TEST_CASE("a version that was never evicted is not taken for an evicted one if a higher one was evicted") {
  Stage stage;
  stage.begin();
  begin_next_epoch(stage);
  const msg::Version executed = stage.next(stage.rest(0), 1);
  stage.drive(executed);
  stage.grant(stage.next(executed, 2));
  stage.advance(60ms);
  stage.report(0);
  evict_excluded(stage);
  list_late(stage, executed);
  check_only(stage, AuditRule::kLedgerPage, 1);
}

TEST_CASE("an initial rest that was never registered is not taken for an evicted one") {
  Stage stage;
  stage.report(0);
  stage.report(1);
  stage.register_versions(0, {stage.rest(0)});
  stage.show_page({stage.rest(0), stage.rest(1)});
  check_only(stage, AuditRule::kLedgerPage, 1);
}

}  // namespace sidestep::auditor_evicted_test
