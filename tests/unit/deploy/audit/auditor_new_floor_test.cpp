// SPDX-License-Identifier: Apache-2.0
// Robots of a later simulator are on a new floor, but coordinators and agents go on with what they know.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_new_floor_test {

using namespace std::chrono_literals;

/// The robot's first report on a new floor.
void report_from_new_floor(Stage& stage, RobotId robot) {
  msg::Feedback robot_report = stage.robot_reports[robot];
  robot_report.header(stage.header("feedback", robot, Stage::kProcessIncarnation + 100'001));
  robot_report.valid_at_ns(to_ns(stage.now));
  stage.auditor.on_robot_report(robot_report, stage.now);
}

TEST_CASE("a robot that registered on its former floor need not register again in that epoch") {
  Stage stage;
  const bool has_registered = GENERATE(true, false);
  stage.register_versions(0, {stage.rest(0)});
  if (has_registered) stage.register_versions(1, {stage.rest(1)});
  stage.report(0), stage.report(1);
  stage.advance(10ms);
  report_from_new_floor(stage, 1);
  stage.grant(stage.next(stage.rest(0), 1));
  check_only(stage, AuditRule::kAllRegistered, has_registered ? 0 : 1);
}

TEST_CASE("an attested absence stays valid when the robot appears on a new floor") {
  Stage stage;
  const bool was_attested = GENERATE(true, false);
  stage.robot_reports[1].obeyed_epoch(stage.epoch - 1);
  stage.register_versions(0, {stage.rest(0)});
  stage.report(0), stage.report(1);
  msg::AbsenceAttestation attestation;
  attestation.robot(1);
  if (was_attested) stage.auditor.on_attestation(attestation, stage.now);
  if (GENERATE(true, false)) {
    stage.grant(stage.next(stage.rest(0), 1));
    stage.advance(1ms);
    report_from_new_floor(stage, 1);
  } else {
    report_from_new_floor(stage, 1);
    stage.grant(stage.next(stage.rest(0), 1));
  }
  check_only(stage, AuditRule::kAllRegistered, was_attested ? 0 : 1);
}

TEST_CASE("only what was proposed may be granted, on the former floor or the new one") {
  Stage stage;
  stage.begin();
  stage.propose({stage.next(stage.rest(0), 1)});
  report_from_new_floor(stage, 0);
  stage.decide(0, 1, 1);
  check_only(stage, AuditRule::kProposed, 0);
  stage.decide(0, 2, 2);
  check_only(stage, AuditRule::kProposed, 1);
}

}  // namespace sidestep::auditor_new_floor_test
