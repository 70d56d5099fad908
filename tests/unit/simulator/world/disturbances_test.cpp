// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include "common/messaging/version_codec.hpp"
#include "simulator/world/cameras.hpp"
#include "simulator/world/disturbance_codec.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"
#include "tests/unit/simulator/world/ideal_agent.hpp"
#include "tests/unit/simulator/world/random_drive.hpp"

namespace sidestep::disturbances_test {

using std::chrono::milliseconds;
using test::disturbance;
using test::IdealAgent;
using test::separated_robots;

const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

RobotDisturbance place(RobotId robot, const Vec2& at_m, double heading_rad) {
  auto placing = disturbance(robot, msg::DisturbanceKind::DISTURBANCE_PLACE);
  placing.place_m = at_m;
  placing.heading_rad = heading_rad;
  return placing;
}

Command rest_version(RobotId robot, VersionNumber number, Time start, const Vec2& at_m) {
  return test::command_with({robot, 1, number, 0, Trajectory::resting(start, at_m)});
}

bool truth_has(const World& world, RobotId robot) {
  msg::GroundTruth truth;
  world.fill(truth);
  return std::any_of(truth.robots().begin(), truth.robots().end(),
                     [robot](const msg::TrueRobotState& seen) { return seen.robot() == robot; });
}

TEST_CASE("a lifted robot is not an obstacle, is invisible, and executes nothing") {
  Scenario scenario = separated_robots(2);
  scenario.field = {4, 4};
  scenario.robots[0].start_m = Vec2(0, 0);
  scenario.robots[1].start_m = Vec2(1, 0);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(30);
  world.advance(now);
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT), now));
  CHECK(world.pending_reports().size() == 1);
  CHECK_FALSE(truth_has(world, 0));
  CHECK(truth_has(world, 1));
  const RobotReport robot_report = world.robot_report(0, now);
  CHECK(robot_report.is_lifted);
  CHECK(robot_report.executing.number == 0);
  Cameras cameras(scenario, kBegin, 1);
  msg::DetectionFrame frame;
  cameras.capture(cameras.next_capture(), {world.bodies()}, frame);
  for (const auto& seen : frame.robots()) CHECK(seen.robot() == 1);
  // The other robot drives through the lifted robot's former position.
  Trajectory dash(now + milliseconds(10), {{1, 0}, {0, 0}});
  dash.append(milliseconds(500), Vec2(-3, 0));
  append_stop(dash, 5);
  world.on_command(1, test::command_with({1, 1, 1, 0, dash}), now);
  world.advance(now + milliseconds(2000));
  CHECK(world.bodies()[1].position_m().x() < 0.5);
  CHECK(world.contacts().contacts == 0);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a lifted robot is put down at the requested place once it executes a rest version there") {
  Scenario scenario = separated_robots(1);
  const bool begins_absent = GENERATE(false, true);
  CAPTURE(begins_absent);
  scenario.robots[0].is_absent = begins_absent;
  World world(scenario, kBegin, 1);
  Time now = kBegin;
  const auto run = [&](int ms) { world.advance(now += milliseconds(ms)); };
  run(10);
  if (!begins_absent) {
    CHECK_FALSE(world.disturb(0, place(0, {1, 1}, 0), now));
    REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT), now));
  }
  CHECK_FALSE(truth_has(world, 0));
  REQUIRE(world.disturb(0, place(0, {3, -2}, 1.5), now));
  run(50);
  CHECK_FALSE(truth_has(world, 0));
  SECTION("a rest version at the requested place") {
    world.on_command(0, rest_version(0, 10, now + milliseconds(10), {3.001, -2}), now);
    run(9);
    CHECK(world.robot_report(0, now).executing.number == 0);
    run(3);
    const RobotReport robot_report = world.robot_report(0, now);
    CHECK(robot_report.executing.number == 10);
    CHECK_FALSE(robot_report.is_lifted);
    CHECK(robot_report.estimate.position_m.x() == Approx(3.001));
    CHECK(truth_has(world, 0));
    CHECK((world.bodies()[0].position_m() - Vec2(3.001, -2)).norm() < 1e-6);
    CHECK(world.bodies()[0].heading_rad() == Approx(1.5));
    // The robot drives on from there.
    Trajectory dash(now + milliseconds(10), {{3.001, -2}, {0, 0}});
    dash.append(milliseconds(200), Vec2(-3, 0));
    append_stop(dash, 5);
    world.on_command(0, test::command_with({0, 1, 11, 10, dash}), now);
    run(1000);
    CHECK(world.reference_error_m(0) < 0.003);
    CHECK(world.firmware(0).executing().number == 11);
    CHECK(world.firmware(0).own_stops() == 0);
  }
  SECTION("a rest version at another place") {
    world.on_command(0, rest_version(0, 10, now + milliseconds(10), {3.01, -2}), now);
    run(100);
    CHECK_FALSE(truth_has(world, 0));
    CHECK(world.robot_report(0, now).is_lifted);
    CHECK(world.robot_report(0, now).executing.number == 10);
    // Only another lifting voids the first rest version and permits a new one.
    world.on_command(0, rest_version(0, 11, now + milliseconds(10), {3, -2}), now);
    run(100);
    CHECK_FALSE(truth_has(world, 0));
    REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT), now));
    REQUIRE(world.disturb(0, place(0, {3, -2}, 1.5), now));
    world.on_command(0, rest_version(0, 12, now + milliseconds(10), {3, -2}), now);
    run(100);
    CHECK(truth_has(world, 0));
  }
  SECTION("a version that moves") {
    Trajectory dash(now + milliseconds(10), {{3, -2}, {1, 0}});
    append_stop(dash, 5);
    world.on_command(0, test::command_with({0, 1, 10, 0, dash}), now);
    run(100);
    CHECK(world.robot_report(0, now).executing.number == 0);
    CHECK(world.firmware(0).counts().refused_base == 1);
  }
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a lifted robot reports its last version, which may be an unreported own stop") {
  World world(separated_robots(1), kBegin, 1);
  Time now = kBegin + milliseconds(10);
  world.advance(now);
  auto push = disturbance(0, msg::DisturbanceKind::DISTURBANCE_PUSH);
  push.push_mps = {1, 0};
  REQUIRE(world.disturb(0, push, now));
  const auto is_off_reference = [&] { return world.firmware(0).is_off_reference(); };
  for (int i = 0; i < 500 && !is_off_reference(); ++i) {
    world.advance(now += milliseconds(1));
    Command command{0, 1, 0};
    command.fix = PoseFix{now - milliseconds(1), world.bodies()[0].position_m(), 0};
    world.on_command(0, command, now);
  }
  REQUIRE(is_off_reference());
  const VersionNumber stop = world.firmware(0).executing().number;
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT), now));
  const RobotReport robot_report = world.robot_report(0, now);
  CHECK(robot_report.is_absent());
  CHECK(robot_report.executing.base == stop);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a version from before a lifting is never executed afterwards") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  const Vec2 mark = scenario.robots[0].start_m;
  world.on_command(0, rest_version(0, 5, kBegin + milliseconds(5), mark), kBegin);
  world.advance(kBegin + milliseconds(10));
  REQUIRE(world.firmware(0).executing().number == 5);
  Time now = kBegin + milliseconds(10);
  world.on_command(0, test::command_with({0, 1, 6, 5, Trajectory::resting(now + milliseconds(20), mark)}),
                   now);
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_LIFT), now));
  world.on_command(0, rest_version(0, 4, now + milliseconds(20), mark), now);
  world.advance(now += milliseconds(50));
  CHECK(world.robot_report(0, now).executing.number == 0);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a rebooted robot rests or brakes off reference, and obeys the same agent as before") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  Trajectory dash(kBegin + milliseconds(10), {scenario.robots[0].start_m, {0, 0}});
  dash.append(milliseconds(500), Vec2(3, 0));
  append_stop(dash, 5);
  auto command = test::command_with({0, 3, 10, 0, dash});
  command.epoch = 7;
  world.on_command(0, command, kBegin);
  const bool moves = GENERATE(false, true);
  Time now = kBegin + milliseconds(moves ? 400 : 2000);
  world.advance(now);
  const Vec2 before = world.bodies()[0].velocity_mps();
  const RobotReport last = world.robot_report(0, now);
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_REBOOT), now));
  world.advance(now += milliseconds(2));
  const RobotReport robot_report = world.robot_report(0, now);
  CHECK(robot_report.is_off_reference);
  CHECK(robot_report.executing.base == 10);
  CHECK(robot_report.executing.number > 10);
  CHECK(robot_report.executing.incarnation == 3);
  CHECK(robot_report.executing.trajectory.start() > last.valid_at);
  CHECK(std::abs(robot_report.executing.trajectory.at_start().velocity_mps.x() - before.x()) < 0.05);
  CHECK(robot_report.obeyed_incarnation == 3);
  CHECK(robot_report.obeyed_epoch == 7);
  CHECK(robot_report.activated == 0);
  CHECK_FALSE(robot_report.command);
  world.advance(now + milliseconds(1000));
  CHECK(world.bodies()[0].velocity_mps().norm() < 0.02);
  CHECK(world.reference_error_m(0) < 0.003);
  // In motion, the robot may lose its new reference once more, until its motor model has converged.
  CHECK(world.firmware(0).own_stops() <= (moves ? 2 : 1));
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE(
    "a robot that forgets its pose brakes silently, then makes its own stop where a fix shows it at rest") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  Trajectory dash(kBegin + milliseconds(10), {scenario.robots[0].start_m, {0, 0}});
  dash.append(milliseconds(500), Vec2(3, 0));
  append_stop(dash, 5);
  world.on_command(0, test::command_with({0, 3, 10, 0, dash}), kBegin);
  Time now = kBegin + milliseconds(400);
  world.advance(now);
  REQUIRE(world.may_report(0));
  const Vec2 before_m = world.bodies()[0].position_m();
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_FORGET_POSE), now));
  const Time forgotten_at = now;
  CHECK_FALSE(world.may_report(0));
  const auto send_fix = [&](Duration age) {
    Command command{0, 3, 0};
    command.fix = PoseFix{now - age, world.bodies()[0].position_m(), world.bodies()[0].heading_rad()};
    world.on_command(0, command, now);
  };
  // A fix of the moving robot does not count.
  for (int i = 0; i < 25; ++i) {
    world.advance(now += milliseconds(10));
    send_fix(milliseconds(5));
  }
  CHECK_FALSE(world.may_report(0));
  world.advance(now += milliseconds(500));
  CHECK(world.bodies()[0].velocity_mps().norm() < 0.02);
  CHECK((world.bodies()[0].position_m() - before_m).norm() < 0.2);  // from 1.2 m/s at 5 m/s^2: 0.14 m
  send_fix(milliseconds(600));
  CHECK_FALSE(world.may_report(0));
  msg::GroundTruth truth;
  world.fill(truth);
  CHECK(truth.robots()[0].disturbance_end_ns() == to_ns(now));
  // A version does not make the robot report while the robot does not know its position.
  world.on_command(0, rest_version(0, 11, now + milliseconds(5), dash.rest_position_m()), now);
  world.advance(now += milliseconds(50));
  send_fix(milliseconds(20));
  CHECK_FALSE(world.may_report(0));  // the robot still executes the version from before it forgot its pose
  world.advance(now += milliseconds(2));
  REQUIRE(world.may_report(0));
  const RobotReport robot_report = world.robot_report(0, now);
  CHECK(robot_report.is_off_reference);
  CHECK(robot_report.executing.number > 11);
  CHECK(robot_report.executing.trajectory.start() > forgotten_at);
  CHECK((robot_report.executing.trajectory.rest_position_m() - world.bodies()[0].position_m()).norm() <
        0.001);
  CHECK(robot_report.executing.inflation_m > 0.004);
  CHECK(robot_report.obeyed_incarnation == 3);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a robot without a pose reports a lifting, and does not regain its pose when switched on") {
  const Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(10);
  world.advance(now);
  const auto disturb = [&](msg::DisturbanceKind kind) { return world.disturb(0, disturbance(0, kind), now); };
  REQUIRE(disturb(msg::DisturbanceKind::DISTURBANCE_FORGET_POSE));
  SECTION("the robot knows that it is lifted") {
    REQUIRE(disturb(msg::DisturbanceKind::DISTURBANCE_LIFT));
    REQUIRE(world.may_report(0));
    CHECK(world.robot_report(0, now).is_lifted);
    CHECK_FALSE(disturb(msg::DisturbanceKind::DISTURBANCE_FORGET_POSE));
  }
  SECTION("switching the robot on does not restore its pose") {
    REQUIRE(disturb(msg::DisturbanceKind::DISTURBANCE_SWITCH_OFF));
    CHECK_FALSE(disturb(msg::DisturbanceKind::DISTURBANCE_FORGET_POSE));
    world.advance(now += milliseconds(100));
    REQUIRE(disturb(msg::DisturbanceKind::DISTURBANCE_SWITCH_ON));
    REQUIRE(disturb(msg::DisturbanceKind::DISTURBANCE_REBOOT));
    world.advance(now += milliseconds(100));
    CHECK_FALSE(world.may_report(0));
  }
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("a robot's facts use the robot's clock, which pauses when it is set back by less than the bound") {
  Scenario scenario = separated_robots(1);
  scenario.robots[0].clock_offset = milliseconds(7);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(10);
  world.advance(now);
  auto command = rest_version(0, 5, now + milliseconds(20), scenario.robots[0].start_m);
  command.sent_at = time_from_ns(12345);
  world.on_command(0, command, now);
  RobotReport robot_report = world.robot_report(0, now);
  CHECK(robot_report.valid_at == now + milliseconds(7));
  REQUIRE(robot_report.command);
  CHECK(robot_report.command->sent_at == time_from_ns(12345));
  CHECK(robot_report.command->received_at == robot_report.valid_at);
  CHECK(world.next_start(0) == now + milliseconds(13));
  world.advance(now += milliseconds(12));
  CHECK(world.firmware(0).executing().number == 0);
  world.advance(now += milliseconds(1));
  CHECK(world.firmware(0).executing().number == 5);

  auto clock = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CLOCK);
  const Duration little = from_seconds(0.8 * scenario.clock_bound_s);
  clock.clock_offset = milliseconds(7) - little;
  REQUIRE(world.disturb(0, clock, now));
  const Time frozen_at = now + milliseconds(7);
  world.advance(now += little / 2);
  CHECK(world.robot_report(0, now).valid_at == frozen_at);
  world.advance(now += milliseconds(30));
  CHECK(world.robot_report(0, now).valid_at == now + milliseconds(7) - little);
  CHECK(world.firmware(0).own_stops() == 0);
  const Incarnation incarnation = world.robot_report(0, now).robot_incarnation;

  // If the clock is set back farther, a new incarnation of the robot begins.
  clock.clock_offset = milliseconds(-30);
  REQUIRE(world.disturb(0, clock, now));
  world.advance(now += milliseconds(20));
  CHECK(world.robot_report(0, now).valid_at == now - milliseconds(30));
  CHECK(world.robot_report(0, now).robot_incarnation == incarnation + 1);
  CHECK(world.firmware(0).own_stops() == 1);
  clock.clock_offset = milliseconds(400);
  REQUIRE(world.disturb(0, clock, now));
  CHECK(world.robot_report(0, now).valid_at == now + milliseconds(400));
  world.advance(now += milliseconds(500));
  CHECK(world.robot_report(0, now).robot_incarnation == incarnation + 1);
  CHECK(world.firmware(0).own_stops() == 1);
  CHECK(world.firmware_violations() == 0);
}

TEST_CASE("ground truth reports when a robot's disturbance ends") {
  World world(separated_robots(1), kBegin, 1);
  Time now = kBegin;
  const auto disturbance_end_ns = [&] {
    msg::GroundTruth truth;
    world.fill(truth);
    return truth.robots().at(0).disturbance_end_ns();
  };
  world.advance(now += milliseconds(100));
  CHECK(disturbance_end_ns() < 0);
  auto clock = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CLOCK);  // does not affect the body
  clock.clock_offset = milliseconds(5);
  REQUIRE(world.disturb(0, clock, now));
  CHECK(disturbance_end_ns() < 0);
  auto slip = disturbance(0, msg::DisturbanceKind::DISTURBANCE_SLIP);
  slip.duration = milliseconds(500);
  REQUIRE(world.disturb(0, slip, now));
  CHECK(disturbance_end_ns() == to_ns(now + milliseconds(500)));
  REQUIRE(world.disturb(0, disturbance(0, msg::DisturbanceKind::DISTURBANCE_PUSH), now));
  CHECK(disturbance_end_ns() == to_ns(now + milliseconds(500)));
  slip.duration = milliseconds(200);  // replaces the first slip
  REQUIRE(world.disturb(0, slip, now));
  const Time end = now + milliseconds(200);
  CHECK(disturbance_end_ns() == to_ns(end));
  world.advance(now += milliseconds(600));
  CHECK(disturbance_end_ns() == to_ns(end));
  auto block = disturbance(0, msg::DisturbanceKind::DISTURBANCE_BLOCK);
  block.duration = milliseconds(100);
  REQUIRE(world.disturb(0, block, now));
  CHECK(disturbance_end_ns() == to_ns(now + milliseconds(100)));
  world.advance(now += milliseconds(600));
  for (const auto kind : {msg::DisturbanceKind::DISTURBANCE_PUSH, msg::DisturbanceKind::DISTURBANCE_REBOOT}) {
    REQUIRE(world.disturb(0, disturbance(0, kind), now));
    CHECK(disturbance_end_ns() == to_ns(now));
    world.advance(now += milliseconds(600));
  }
}

TEST_CASE("ground truth reports a clock jump beyond the bound while the robot drives or is about to drive") {
  Scenario scenario = separated_robots(1);
  World world(scenario, kBegin, 1);
  Time now = kBegin + milliseconds(30);
  const auto disturbance_end_ns = [&] {
    msg::GroundTruth truth;
    world.fill(truth);
    return truth.robots().at(0).disturbance_end_ns();
  };
  auto clock = disturbance(0, msg::DisturbanceKind::DISTURBANCE_CLOCK);
  const auto set_clock = [&](Duration offset) {
    clock.clock_offset = offset;
    REQUIRE(world.disturb(0, clock, now));
  };
  world.advance(now);
  set_clock(milliseconds(4));
  CHECK(disturbance_end_ns() < 0);
  Trajectory dash(now + milliseconds(20), {world.bodies()[0].position_m(), {0, 0}});
  dash.append(milliseconds(200), Vec2(3, 0));
  append_stop(dash, 5);
  world.on_command(0, test::command_with({0, 1, 1, 0, dash}), now);
  set_clock(milliseconds(5));
  CHECK(disturbance_end_ns() == to_ns(now));
  world.advance(now += milliseconds(100));
  const std::int64_t first_ns = disturbance_end_ns();
  set_clock(milliseconds(5) + from_seconds(0.9 * scenario.clock_bound_s));
  CHECK(disturbance_end_ns() == first_ns);
  set_clock(milliseconds(13));
  CHECK(disturbance_end_ns() == to_ns(now));
  world.advance(now += milliseconds(1000));
  const std::int64_t last_ns = disturbance_end_ns();
  set_clock(milliseconds(18));
  CHECK(disturbance_end_ns() == last_ns);
}

TEST_CASE("a robot with a drifting clock uses observations and follows its reference") {
  Scenario scenario = separated_robots(1);
  scenario.robots[0].clock_drift_ppm = GENERATE(-90.0, 90.0);
  CAPTURE(scenario.robots[0].clock_drift_ppm);
  World world(scenario, kBegin, 1);
  Time now = kBegin + std::chrono::seconds(10);
  world.advance(now);
  const Duration gained = from_seconds(10e-6 * scenario.robots[0].clock_drift_ppm);
  CHECK(world.robot_time(0, now) == now + gained);
  Command command = test::command_with({0, 1, 0, 0, Trajectory::resting(now, Vec2(0, 0))});
  command.version.reset();
  const double before_m = world.robot_report(0, now).uncertainty.position_error_rms_m;
  command.fix = PoseFix{now + gained - milliseconds(20), world.bodies()[0].position_m(), 0};
  world.on_command(0, command, now);
  CHECK(world.robot_report(0, now).uncertainty.position_error_rms_m < 0.6 * before_m);
}

TEST_CASE("under random disturbances, firmware keeps its rules and robots end at reported positions") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 21));
  CAPTURE(seed);
  Scenario scenario = separated_robots(4);
  World world(scenario, kBegin, seed);
  Rng rng(seed);
  std::vector<IdealAgent> agents;
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    agents.emplace_back(scenario, world, i, 10 * seed + i);
    agents.back().place_m = scenario.robots[i].start_m;
  }
  struct LastReport {
    Time at;
    VersionNumber executing;
  };
  std::vector<std::map<VersionNumber, msg::Version>> known(world.robot_count());
  std::vector<LastReport> latest(world.robot_count(), LastReport{Time::min(), 0});
  for (Time now = kBegin; now < kBegin + std::chrono::seconds(8);) {
    now += kPhysicsStep;
    world.advance(now);
    for (std::size_t i = 0; i < agents.size(); ++i) {
      agents[i].act(now);
      const RobotReport robot_report = world.robot_report(i, now);
      const VersionNumber number = robot_report.executing.number;
      const msg::Version executing = encode(robot_report.executing);
      const auto [same, is_new] = known[i].emplace(number, executing);
      if (!is_new && number > 0) REQUIRE(same->second == executing);
      REQUIRE(robot_report.valid_at >= latest[i].at);
      if (!robot_report.is_lifted && number != latest[i].executing && latest[i].executing > 0) {
        REQUIRE(robot_report.executing.trajectory.start() > latest[i].at);
        REQUIRE(number > latest[i].executing);
      }
      latest[i] = {robot_report.valid_at, number};
    }
    if (now > kBegin + std::chrono::seconds(6) || !rng.chance(0.005)) continue;
    const std::size_t robot = rng.below(world.robot_count());
    RobotDisturbance any = disturbance(world.id(robot), static_cast<msg::DisturbanceKind>(rng.below(7)));
    any.push_mps.x() = rng.uniform(-2, 2);
    any.push_mps.y() = rng.uniform(-2, 2);
    any.grip = rng.uniform();
    any.duration = Duration{static_cast<std::int64_t>(rng.below(500'000'000))};
    any.heading_rad = rng.uniform(-3, 3);
    any.place_m = agents[robot].place_m;
    any.clock_offset = Duration{static_cast<std::int64_t>(rng.below(6'000'000)) - 3'000'000};
    REQUIRE(decode(encode(any), scenario.field, scenario.radius_m));
    (void)world.disturb(robot, any, now);
    if (now > kBegin + std::chrono::seconds(5)) {
      for (IdealAgent& agent : agents) agent.drives = false;
    }
  }
  CHECK(world.firmware_violations() == 0);
  for (std::size_t i = 0; i < world.robot_count(); ++i) {
    CAPTURE(i);
    CHECK(world.reference_error_m(i) <
          scenario.tracking_bound_m + world.firmware(i).executing().inflation_m + 0.002 * agents[i].drives);
  }
}

}  // namespace sidestep::disturbances_test
