// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/deploy/audit/stage.hpp"

#include <algorithm>

#include "tests/catch.hpp"

namespace sidestep {

using namespace std::chrono_literals;

namespace {

// These rules do not concern an epoch.
constexpr AuditRule kWithoutEpoch[] = {AuditRule::kUniqueVersion,   AuditRule::kSent,
                                       AuditRule::kSwitch,          AuditRule::kLateSwitch,
                                       AuditRule::kOffReference,    AuditRule::kTracking,
                                       AuditRule::kPosition,        AuditRule::kContact,
                                       AuditRule::kCrash,           AuditRule::kFirmwareMonitor,
                                       AuditRule::kStaleIncarnation};

}  // namespace

Scenario stage_scenario() {
  Scenario scenario;
  scenario.field.length_m = 6;
  scenario.field.width_m = 4;
  scenario.robots.resize(2);
  for (RobotId robot = 0; robot < 2; ++robot) {
    scenario.robots[robot].id = robot;
    scenario.robots[robot].start_m = {robot == 0 ? -1 : 1, 0};
  }
  return scenario;
}

Stage::Stage(Scenario staged, const AuditInput& input)
    : scenario(std::move(staged)), auditor(scenario, input) {
  auditor.on_violation([this](const Violation& violation) {
    CHECK(violation.detected == now);
    if (std::ranges::count(kWithoutEpoch, violation.rule) > 0) CHECK(violation.epoch == 0);
    violations.push_back(violation);
  });
  for (RobotId robot = 0; robot < 2; ++robot) {
    robot_reports[robot].robot(robot);
    robot_reports[robot].executing(rest(robot));
    robot_reports[robot].obeyed_epoch(epoch);
    robot_reports[robot].obeyed_incarnation(kAgent);
  }
}

void Stage::begin() {
  for (RobotId robot = 0; robot < 2; ++robot) {
    register_versions(robot, {robot_reports[robot].executing()});
    report(robot);
  }
  advance(10ms);
}

msg::Version Stage::rest(RobotId robot) const {
  msg::Version version;
  version.robot(robot);
  version.start_ns(to_ns(Time{999s}));
  version.x_m(scenario.robots[robot].start_m.x());
  version.y_m(scenario.robots[robot].start_m.y());
  return version;
}

msg::Version Stage::next(const msg::Version& base, VersionNumber number, Duration in) const {
  const AuditPath::Node from = AuditPath(base).at_ns(to_ns(now + in));
  msg::Version version;
  version.robot(base.robot());
  version.incarnation(kAgent);
  version.version_number(number);
  version.base(base.version_number());
  version.start_ns(to_ns(now + in));
  version.x_m(from.x);
  version.y_m(from.y);
  version.vx_mps(from.vx);
  version.vy_mps(from.vy);
  return version;
}

void Stage::advance(Duration duration) { now += duration; }

void Stage::report(RobotId robot) { report(robot_reports[robot]); }

void Stage::report(const msg::Feedback& robot_report) {
  msg::Feedback message = robot_report;
  message.header(header("feedback", robot_report.robot()));
  if (message.valid_at_ns() == 0) message.valid_at_ns(to_ns(now));
  auditor.on_robot_report(message, now);
}

void Stage::register_versions(RobotId robot, const std::vector<msg::Version>& versions) {
  msg::Registration registration;
  registration.robot(robot);
  registration.header(header("registration", robot, kAgent));
  registration.epoch(epoch);
  registration.version_count(static_cast<std::uint8_t>(versions.size()));
  std::ranges::copy(versions, registration.versions().begin());
  auditor.on_registration(registration, now);
}

void Stage::propose(const std::vector<msg::Version>& candidates) {
  msg::Proposal proposal;
  proposal.robot(candidates.front().robot());
  proposal.header(header("proposal", proposal.robot(), candidates.front().incarnation()));
  proposal.epoch(epoch);
  proposal.candidate_count(static_cast<std::uint8_t>(candidates.size()));
  std::ranges::copy(candidates, proposal.candidates().begin());
  auditor.on_proposal(proposal, now);
}

void Stage::decide(RobotId robot, std::uint64_t proposal, VersionNumber granted, msg::Reason reason) {
  msg::Verdict verdict;
  verdict.robot(robot);
  verdict.header(header("verdict", coordinator, coordinator_incarnation));
  verdict.epoch(epoch);
  verdict.proposal_number(proposal);
  verdict.request_stamp_ns(to_ns(now));
  verdict.granted_version(granted);
  verdict.reasons().fill(granted == 0 ? reason : msg::Reason::REASON_GRANTED);
  auditor.on_verdict(verdict, now);
}

void Stage::grant(const msg::Version& version) {
  propose({version});
  decide(version.robot(), version.version_number(), version.version_number());
}

void Stage::command(const msg::Version& version) {
  msg::Command command;
  command.robot(version.robot());
  command.header(header("command", version.robot(), version.incarnation()));
  command.epoch(epoch);
  command.has_version(true);
  command.version(version);
  auditor.on_command(command, now);
}

void Stage::drive(const msg::Version& version) {
  grant(version);
  command(version);
  now = std::max(now, time_from_ns(version.start_ns()));
  robot_reports[version.robot()].executing(version);
  report(version.robot());
}

void Stage::show_page(const std::vector<msg::Version>& versions) {
  msg::LedgerPage page;
  page.header(header("ledger", coordinator, coordinator_incarnation));
  page.epoch(epoch);
  page.versions(versions);
  auditor.on_ledger(page, now);
}

msg::Header Stage::header(std::string_view topic, std::uint32_t sender, Incarnation incarnation) {
  msg::Header header;
  header.sender(sender);
  header.incarnation(incarnation);
  header.message_number(++sent_[{topic, sender, incarnation}]);
  header.stamp_ns(to_ns(now));
  return header;
}

std::uint64_t Stage::count(AuditRule rule) const {
  return static_cast<std::uint64_t>(std::ranges::count(violations, rule, &Violation::rule));
}

std::string Stage::lines() const {
  std::string text;
  for (const Violation& violation : violations) text += to_line(violation) + "\n";
  return text;
}

msg::Version moving(msg::Version version, double speed_mps) {
  version.phase_count(2);
  version.phases()[0].duration_ns(1'000'000'000);
  version.phases()[0].ax_mps2(speed_mps);
  version.phases()[1].duration_ns(1'000'000'000);
  version.phases()[1].ax_mps2(-speed_mps);
  return version;
}

void check_only(const Stage& stage, AuditRule rule, std::uint64_t expected) {
  INFO(stage.lines());
  CHECK(stage.count(rule) == expected);
  CHECK(stage.violations.size() == stage.count(rule));
}

}  // namespace sidestep
