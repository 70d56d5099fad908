// SPDX-License-Identifier: Apache-2.0
// Single robot reports as evidence about epochs, registrations and incarnations of robots.
#include "common/motion/safety_budget.hpp"
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_epochs_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("a robot must not execute a version sent under an older epoch than it already obeyed") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1, 50ms);
  stage.grant(first);
  bool is_stale = false;
  const auto obey = [&] {
    stage.advance(1ms);
    stage.robot_reports[0].obeyed_epoch(stage.epoch + 1);
    stage.report(0);
    stage.advance(1ms);
  };
  SECTION("the version was sent before the robot obeyed the newer epoch") {
    stage.command(first);
    obey();
  }
  SECTION("the version was sent at the time of the first report with the newer epoch") {
    stage.advance(1ms);
    stage.robot_reports[0].obeyed_epoch(stage.epoch + 1);
    stage.report(0);
    stage.command(first);
  }
  SECTION("the version was sent after the first report with the newer epoch") {
    obey();
    stage.report(0);
    stage.command(first);
    is_stale = true;
  }
  SECTION("the version was sent under the newer epoch after its first report") {
    obey();
    ++stage.epoch;
    stage.command(first);
    --stage.epoch;
  }
  stage.now = time_from_ns(first.start_ns());
  stage.robot_reports[0].executing(first);
  stage.report(0);
  check_only(stage, AuditRule::kStaleEpoch, is_stale ? 1 : 0);
  if (is_stale) CHECK(stage.violations.front().epoch == stage.epoch);
}

TEST_CASE("a robot that obeys an epoch older than that of a grant is reported once") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.robot_reports[1].obeyed_epoch(stage.epoch - 1);
  stage.register_versions(0, {stage.rest(0)}), stage.register_versions(1, {stage.rest(1)});
  stage.report(0);
  bool is_excused = false;
  SECTION("the robot has no excuse") { stage.report(1); }
  SECTION("the robot was attested absent") {
    msg::AbsenceAttestation attestation;
    attestation.robot(1);
    stage.auditor.on_attestation(attestation, stage.now);
    is_excused = true;
  }
  SECTION("another robot was attested absent") {
    msg::AbsenceAttestation attestation;
    attestation.robot(0);
    stage.auditor.on_attestation(attestation, stage.now);
  }
  SECTION("the robot is lifted") {
    stage.robot_reports[1].is_lifted(true);
    is_excused = true;
  }
  const msg::Version first = stage.next(stage.rest(0), 1);
  stage.grant(first);
  stage.report(1);
  CHECK(stage.violations.empty());  // the report may have been sent before the grant
  stage.advance(1ms);
  for (int i = 0; i < 3; ++i) stage.report(1);
  CHECK(stage.count(AuditRule::kAllRegistered) == (is_complete && !is_excused ? 1 : 0));
}

TEST_CASE(
    "a robot that executes a version of an epoch must obey that epoch, even if messages may be missed") {
  Stage stage(stage_scenario(), kIncomplete);
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1);
  const bool is_proposed = GENERATE(true, false);
  if (is_proposed)
    stage.grant(first);
  else
    stage.decide(0, 1, 1);
  const bool is_obeyed = GENERATE(true, false);
  if (!is_obeyed) stage.robot_reports[0].obeyed_epoch(stage.epoch - 1);
  CAPTURE(is_proposed, is_obeyed);
  stage.now = time_from_ns(first.start_ns());
  stage.robot_reports[0].executing(first);
  for (int i = 0; i < 3; ++i) stage.report(0);
  CHECK(stage.count(AuditRule::kAllRegistered) == (is_proposed && !is_obeyed ? 1 : 0));
}

/// Robot 0 executes version 1 of the previous epoch when its agent registers in the next epoch.
struct RegistrationStage : Stage {
  explicit RegistrationStage(const AuditInput& input) : Stage(stage_scenario(), input) {
    begin();
    first = next(rest(0), 1);
    drive(first);
    ++epoch;
    robot_reports[0].obeyed_epoch(epoch);
    report(0);
    advance(1ms);
  }
  /// The robot reports the time of a command that was sent after the registration.
  void report_later() {
    advance(1ms);
    robot_reports[0].command_stamp_ns(to_ns(now));
    report(0);
    report(0);
  }

  msg::Version first;
};

TEST_CASE("an agent must register its robot's version after the robot has acknowledged agent and epoch") {
  const bool is_complete = GENERATE(true, false);
  RegistrationStage stage(is_complete ? kComplete : kIncomplete);
  std::uint64_t missing = 0, early = 0;
  SECTION("the agent registers the version") { stage.register_versions(0, {stage.rest(0), stage.first}); }
  SECTION("the agent does not register the version") {
    stage.register_versions(0, {stage.rest(0)});
    missing = 1;
  }
  SECTION("the unregistered version was replaced by a version of the new epoch") {
    stage.register_versions(0, {stage.rest(0)});
    stage.register_versions(1, {stage.rest(1)});
    stage.robot_reports[1].obeyed_epoch(stage.epoch);
    const msg::Version second = stage.next(stage.first, 2);
    stage.grant(second);
    stage.command(second);
    stage.now = time_from_ns(second.start_ns());
    stage.robot_reports[0].executing(second);
    stage.violations.clear();  // the version's base is not in the ledger
  }
  SECTION("the robot does not obey the epoch yet") {
    ++stage.epoch;
    stage.register_versions(0, {stage.rest(0), stage.first});
    early = 1;
  }
  SECTION("the robot is off its reference") {
    stage.register_versions(0, {stage.rest(0)});
    msg::Version stop = stage.next(stage.first, 9, 0ms);
    stage.robot_reports[0].executing(stop);
    stage.robot_reports[0].is_off_reference(true);
  }
  SECTION("the robot is lifted") {
    stage.register_versions(0, {stage.rest(0)});
    stage.robot_reports[0].is_lifted(true);
  }
  stage.report_later();
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kRegistration) == missing);
  CHECK(stage.count(AuditRule::kAcknowledged) == early);
  if (missing + early > 0) CHECK(stage.violations.front().epoch == stage.epoch);
  CHECK(stage.violations.size() == missing + early);
}

TEST_CASE("a robot that obeys an older agent has not acknowledged the agent that registers") {
  RegistrationStage stage(kComplete);
  stage.robot_reports[0].obeyed_incarnation(Stage::kAgent);
  msg::Registration registration;
  registration.header(stage.header("registration", 0, Stage::kAgent + 1));
  registration.epoch(stage.epoch);
  registration.version_count(1);
  registration.versions()[0] = stage.first;
  stage.auditor.on_registration(registration, stage.now);
  stage.report(0);
  CHECK(stage.violations.empty());  // the report may have been sent before the registration
  stage.report_later();
  CHECK(stage.count(AuditRule::kAcknowledged) == 1);
}

TEST_CASE("if messages may be missed, only a command's time proves that a report followed a registration") {
  RegistrationStage stage(kIncomplete);
  stage.register_versions(0, {stage.rest(0)});
  const std::int64_t registered_ns = to_ns(stage.now);
  std::uint64_t expected = 0;
  SECTION("the command was sent before the registration") {
    stage.robot_reports[0].command_stamp_ns(registered_ns - 1);
  }
  SECTION("the command was sent at the time of the registration") {
    stage.robot_reports[0].command_stamp_ns(registered_ns);
  }
  SECTION("the command was sent after the registration") {
    stage.robot_reports[0].command_stamp_ns(registered_ns + 1);
    expected = 1;
  }
  SECTION("another agent sent the command after the registration") {
    stage.robot_reports[0].command_stamp_ns(registered_ns + 1);
    stage.robot_reports[0].obeyed_incarnation(Stage::kAgent + 1);
  }
  SECTION("the agent's clock was set back") {
    stage.now -= 5ms;
    stage.register_versions(0, {stage.rest(0)});
    stage.robot_reports[0].command_stamp_ns(registered_ns + 1);
    stage.now += 5ms;
  }
  stage.advance(1ms);
  stage.report(0);
  check_only(stage, AuditRule::kRegistration, expected);
}

TEST_CASE(
    "reports of a robot's earlier incarnation are ignored until the robot has been silent for a second") {
  const bool is_near = GENERATE(true, false);
  const bool was_silent = GENERATE(true, false);
  CAPTURE(is_near, was_silent);
  Stage stage;
  const Incarnation before = Stage::kProcessIncarnation + 1'000'000 - (is_near ? 100'000 : 100'001);
  const auto report = [&](Incarnation robot_incarnation, double x_m) {
    msg::Feedback robot_report = stage.robot_reports[0];
    robot_report.header(stage.header("feedback", 0, robot_incarnation));
    robot_report.valid_at_ns(to_ns(stage.now));
    robot_report.executing().x_m(x_m);
    stage.auditor.on_robot_report(robot_report, stage.now);
  };
  report(Stage::kProcessIncarnation + 1'000'000, -1);
  stage.advance(was_silent ? 1s : 999ms);
  // If the report counts, a robot at rest elsewhere must be on another floor.
  report(before, -2);
  CHECK(stage.violations.empty());
  report(before, -2.5);
  const bool counts = !is_near && was_silent;
  CHECK(stage.count(AuditRule::kUniqueVersion) == (counts ? 1 : 0));
}

TEST_CASE("a robot of a later simulator is on a new floor, but a robot with restarted firmware is not") {
  const auto [later, is_new_floor] =
      GENERATE(table<Incarnation, bool>({{1, false}, {100'000, false}, {100'001, true}}));
  CAPTURE(later);
  Stage stage;
  stage.begin();
  msg::Feedback robot_report = stage.robot_reports[0];
  robot_report.header(stage.header("feedback", 0, Stage::kProcessIncarnation + later));
  robot_report.valid_at_ns(to_ns(stage.now));
  robot_report.executing().x_m(-2);
  stage.auditor.on_robot_report(robot_report, stage.now);
  CHECK(stage.count(AuditRule::kUniqueVersion) == (is_new_floor ? 0 : 1));
  // The ledger may still contain versions from the former floor.
  if (!is_new_floor) return;
  msg::Version former = stage.next(stage.rest(0), 7);
  stage.show_page({former, stage.rest(1)});
  CHECK(stage.count(AuditRule::kLedgerPage) == 0);
  ++stage.epoch;
  stage.show_page({former, stage.rest(1)});
  CHECK(stage.count(AuditRule::kLedgerPage) == 2);
}

TEST_CASE("a version executed without a command is reported once") {
  Stage stage;
  stage.begin();
  const msg::Version first = stage.next(stage.rest(0), 1);
  stage.grant(first);
  stage.now = time_from_ns(first.start_ns());
  stage.robot_reports[0].executing(first);
  stage.report(0);
  stage.report(0);
  check_only(stage, AuditRule::kSent, 1);
}

}  // namespace sidestep::auditor_epochs_test
