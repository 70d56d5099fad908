// SPDX-License-Identifier: Apache-2.0
// Which single messages of agents and coordinators are invalid, and what valid messages prove.
#include "tests/catch.hpp"
#include "tests/unit/deploy/audit/stage.hpp"

namespace sidestep::auditor_messages_test {

using namespace std::chrono_literals;

constexpr AuditInput kIncomplete{};

TEST_CASE("invalid messages are counted one by one and change nothing") {
  Stage stage;
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 1);
  msg::Version of_other = version;
  of_other.robot(1);
  SECTION("a proposal has no or too many candidates") {
    msg::Proposal proposal;
    proposal.candidate_count(GENERATE(std::uint8_t{0}, std::uint8_t{msg::MAX_CANDIDATES + 1}));
    proposal.header(stage.header("proposal", 0));
    stage.auditor.on_proposal(proposal, stage.now);
  }
  SECTION("another robot's agent sends a proposal") {
    msg::Proposal proposal;
    proposal.candidate_count(1);
    proposal.header(stage.header("proposal", 1));
    stage.auditor.on_proposal(proposal, stage.now);
  }
  SECTION("a proposal names a robot that is not on the roster") {
    const std::uint32_t robot = GENERATE(2u, 1023u, 1024u, 4'000'000'000u);
    msg::Proposal proposal;
    proposal.robot(robot);
    proposal.candidate_count(1);
    proposal.header(stage.header("proposal", robot));
    stage.auditor.on_proposal(proposal, stage.now);
  }
  SECTION("a registration has no epoch or too many versions") {
    msg::Registration registration;
    const bool has_epoch = GENERATE(false, true);
    registration.epoch(has_epoch ? 5 : 0);
    registration.version_count(has_epoch ? msg::MAX_REGISTERED_VERSIONS + 1 : 1);
    registration.header(stage.header("registration", 0));
    stage.auditor.on_registration(registration, stage.now);
  }
  SECTION("a registration lists another robot's version") { stage.register_versions(0, {of_other}); }
  SECTION("another robot's agent sends a registration") {
    msg::Registration registration;
    registration.epoch(5);
    registration.header(stage.header("registration", 1));
    stage.auditor.on_registration(registration, stage.now);
  }
  SECTION("another robot's agent sends a command") {
    msg::Command command;
    command.header(stage.header("command", 1));
    stage.auditor.on_command(command, stage.now);
  }
  SECTION("a command contains another robot's version") {
    msg::Command command;
    command.header(stage.header("command", 0));
    command.has_version(true);
    command.version(of_other);
    stage.auditor.on_command(command, stage.now);
  }
  SECTION("a verdict names an unknown robot") { stage.decide(GENERATE(2u, 4'000'000'000u), 1, 1); }
  SECTION("an attestation names an unknown robot") {
    msg::AbsenceAttestation attestation;
    attestation.robot(GENERATE(2u, 4'000'000'000u));
    stage.auditor.on_attestation(attestation, stage.now);
  }
  SECTION("a disturbance names an unknown robot or has an unknown kind") {
    msg::Disturbance disturbance;
    const bool is_known = GENERATE(true, false);
    disturbance.robot(is_known ? 0 : 2);
    disturbance.disturbance_kind(is_known ? static_cast<msg::DisturbanceKind>(99)
                                          : msg::DisturbanceKind::DISTURBANCE_PUSH);
    stage.auditor.on_disturbance(disturbance, stage.now);
  }
  SECTION("a robot report contains impossible numbers") {
    msg::Feedback robot_report = stage.robot_reports[0];
    SECTION("x") { robot_report.x_m(INFINITY); }
    SECTION("y") { robot_report.y_m(NAN); }
    SECTION("speed along x") { robot_report.vx_mps(NAN); }
    SECTION("speed along y") { robot_report.vy_mps(-INFINITY); }
    SECTION("tracking error") { robot_report.tracking_error_m(NAN); }
    SECTION("time") {
      robot_report.valid_at_ns(GENERATE(std::int64_t{-1}, std::numeric_limits<std::int64_t>::max()));
    }
    stage.report(robot_report);
  }
  SECTION("a robot report contains another robot's version") {
    msg::Feedback robot_report = stage.robot_reports[0];
    robot_report.executing(of_other);
    stage.report(robot_report);
  }
  SECTION("another robot sends a robot report") {
    msg::Feedback robot_report = stage.robot_reports[0];
    robot_report.header(stage.header("feedback", 1));
    stage.auditor.on_robot_report(robot_report, stage.now);
  }
  SECTION("world states and ground truth have an invalid time or too many robots") {
    const bool has_time = GENERATE(true, false);
    msg::WorldState world;
    world.valid_at_ns(has_time ? 1 : -1);
    world.robots().resize(has_time ? kMaxRobots + 1 : 0);
    world.header(stage.header("world", 20'000));
    stage.auditor.on_world_state(world, stage.now);
    CHECK(stage.auditor.totals().invalid == 1);
    msg::GroundTruth truth;
    truth.valid_at_ns(has_time ? 1 : -1);
    truth.robots().resize(has_time ? kMaxRobots + 1 : 0);
    truth.header(stage.header("truth", 30'000));
    stage.auditor.on_truth(truth, stage.now);
    CHECK(stage.auditor.totals().invalid == 2);
    return;
  }
  CHECK(stage.auditor.totals().invalid == 1);
  CHECK(stage.violations.empty());
  stage.grant(version);
  CHECK(stage.violations.empty());
}

TEST_CASE("robot ids up to 1023 are valid") {
  const RobotId robot = GENERATE(2u, 820u, 1023u);
  Scenario scenario = stage_scenario();
  scenario.robots[1].id = robot;
  Auditor auditor(scenario, kComplete);
  msg::Feedback robot_report;
  robot_report.robot(robot);
  robot_report.header().sender(robot);
  robot_report.header().message_number(1);
  robot_report.executing().robot(robot);
  auditor.on_robot_report(robot_report, Time{1s});
  msg::Disturbance disturbance;
  disturbance.robot(robot);
  auditor.on_disturbance(disturbance, Time{1s});
  msg::Verdict verdict;
  verdict.robot(robot);
  auditor.on_verdict(verdict, Time{1s});
  CHECK(auditor.totals().received == 2);
  CHECK(auditor.totals().invalid == 0);
}

TEST_CASE("a version number identifies one version of one agent") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  const msg::Version version = stage.next(stage.rest(0), 1);
  stage.grant(version);
  msg::Version other = version;
  SECTION("the same version again") {
    stage.command(other);
    CHECK(stage.violations.empty());
  }
  SECTION("a different version from the same agent") {
    other.y_m(0.1);
    stage.command(other);
    CHECK(stage.count(AuditRule::kUniqueVersion) == 1);
    CHECK(stage.violations.front().robot == 0);
    CHECK(stage.violations.front().version == 1);
    CHECK(stage.violations.front().epoch == 0);
  }
  SECTION("a different version from another agent, whose grant may have been missed") {
    other.incarnation(other.incarnation() + 1);
    stage.command(other);
    CHECK(stage.count(AuditRule::kUniqueVersion) == (is_complete ? 1 : 0));
  }
  SECTION("a robot's initial rest on another floor") {
    msg::Version rest = stage.rest(1);
    rest.x_m(1.5);
    stage.register_versions(1, {rest});
    CHECK(stage.count(AuditRule::kUniqueVersion) == (is_complete ? 1 : 0));
  }
}

/// A heartbeat that reports these robots as missing.
msg::CoordinatorState state(Stage& stage, msg::CoordinatorMode mode,
                            const std::vector<RobotId>& missing = {}) {
  msg::CoordinatorState state;
  state.header(stage.header("coordinator", Stage::kCoordinator, stage.coordinator_incarnation));
  state.epoch(stage.epoch);
  state.coordinator_mode(mode);
  for (const RobotId robot : missing) {
    state.notices().emplace_back().robot(robot);
    state.notices().back().is_missing(true);
  }
  return state;
}

TEST_CASE("a coordinator that reports a missing registration after a grant is reported once") {
  constexpr auto kMode = msg::CoordinatorMode::COORDINATOR_REGISTERING;
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  stage.begin();
  std::uint64_t expected = 0;
  SECTION("the coordinator reports before the grant") {
    stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
    stage.advance(1ms);
    stage.grant(stage.next(stage.rest(0), 1));
  }
  SECTION("the coordinator reports at the time of the grant") {
    stage.grant(stage.next(stage.rest(0), 1));
    stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
  }
  SECTION("the coordinator reports after the grant") {
    stage.grant(stage.next(stage.rest(0), 1));
    stage.advance(1ns);
    SECTION("no registration is missing") { stage.auditor.on_coordinator(state(stage, kMode), stage.now); }
    SECTION("a registration is missing") {
      stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
      stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
      expected = 1;
      CHECK(stage.violations.front().robot == 1);
      CHECK(stage.violations.front().epoch == stage.epoch);
    }
    SECTION("a registration is missing in another epoch") {
      ++stage.epoch;
      stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
    }
    SECTION("a registration is missing in another run of the coordinator") {
      ++stage.coordinator_incarnation;
      stage.auditor.on_coordinator(state(stage, kMode, {1}), stage.now);
    }
    SECTION("the coordinator's clock was set back") {
      stage.advance(1ns);
      stage.auditor.on_coordinator(state(stage, kMode), stage.now);
      msg::CoordinatorState late = state(stage, kMode, {1});
      late.header().stamp_ns(to_ns(stage.now) - 1);
      stage.auditor.on_coordinator(late, stage.now);
      // An auditor that receives every message immediately knows the order from its own clock.
      expected = is_complete ? 1 : 0;
    }
  }
  INFO(stage.lines());
  CHECK(stage.count(AuditRule::kAllRegistered) == expected);
  CHECK(stage.violations.size() == expected);
}

/// A command without a version.
void command(Stage& stage, Epoch epoch, Incarnation agent = Stage::kAgent) {
  msg::Command command;
  command.header(stage.header("command", 0, agent));
  command.epoch(epoch);
  stage.auditor.on_command(command, stage.now);
}

TEST_CASE("an agent never returns to a lower epoch") {
  const bool is_complete = GENERATE(true, false);
  Stage stage(stage_scenario(), is_complete ? kComplete : kIncomplete);
  command(stage, 5);
  command(stage, 6);
  std::uint64_t expected = 0;
  SECTION("the same epoch and higher epochs") {
    for (const Epoch epoch : {6u, 7u, 7u, 9u}) command(stage, epoch);
  }
  SECTION("a lower epoch") {
    command(stage, 5);
    command(stage, 6);
    command(stage, 5);
    expected = 2;
    CHECK(stage.violations.front().epoch == 5);
  }
  SECTION("another agent begins with a lower epoch") {
    command(stage, 4, Stage::kAgent + 1);
    command(stage, 5, Stage::kAgent + 1);
    command(stage, 6);
    command(stage, 4, Stage::kAgent + 1);
    expected = 1;
  }
  SECTION("an earlier command arrives late") {
    msg::Command late;
    late.header(stage.header("command", 0, Stage::kAgent));
    late.epoch(5);
    command(stage, 6);
    stage.auditor.on_command(late, stage.now);
    command(stage, 6);
  }
  SECTION("only the latest of many agents are remembered") {
    for (Incarnation other = 1; other <= 7; ++other) command(stage, 5, Stage::kAgent + other);
    command(stage, 5);
    CHECK(stage.count(AuditRule::kEpochRegression) == 1);
    command(stage, 6);
    command(stage, 5, Stage::kAgent + 8);
    command(stage, 5);
    expected = 1;
  }
  CHECK(stage.count(AuditRule::kEpochRegression) == expected);
  CHECK(stage.violations.size() == expected);
}

TEST_CASE("a run begins once all robots may move and are heard, at most a second after they may move") {
  Stage stage(stage_scenario(), kIncomplete);
  const auto run_s = [&] {
    stage.auditor.advance(stage.now);
    return stage.auditor.totals().run_s;
  };
  const auto granting = [&] {
    stage.auditor.on_coordinator(state(stage, msg::CoordinatorMode::COORDINATOR_GRANTING), stage.now);
  };
  stage.report(0);
  stage.advance(5s);
  SECTION("no robot may move yet") {
    stage.auditor.on_coordinator(state(stage, msg::CoordinatorMode::COORDINATOR_REGISTERING), stage.now);
    stage.advance(2s);
    CHECK(run_s() == 0);
  }
  SECTION("all robots were heard") {
    stage.report(1);
    granting();
    stage.advance(2s);
    granting();
    CHECK(run_s() == Approx(2));
  }
  SECTION("the last robot is heard later") {
    granting();
    stage.advance(300ms);
    stage.report(1);
    granting();
    stage.advance(2s);
    CHECK(run_s() == Approx(2));
  }
  SECTION("one robot is never heard") {
    granting();
    stage.advance(999ms);
    granting();
    CHECK(run_s() == 0);
    stage.advance(1ms);
    granting();
    stage.advance(2s);
    CHECK(run_s() == Approx(2));
  }
}

}  // namespace sidestep::auditor_messages_test
