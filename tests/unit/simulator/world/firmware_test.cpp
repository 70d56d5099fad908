// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/firmware.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "common/messaging/robot_codec.hpp"
#include "common/random/rng.hpp"
#include "simulator/world/firmware_monitor.hpp"
#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"

namespace sidestep::firmware_test {

using std::chrono::milliseconds;
using test::bare_command;
using test::command_with;

constexpr RobotId kRobot = 7;
constexpr Incarnation kFirst = 100;
constexpr Incarnation kSecond = 200;
const Time kBegin = time_from_ns(1'700'000'000'000'000'000);
const Vec2 kStart(1, -2);

Time at(int ms) { return kBegin + milliseconds(ms); }

Version version(VersionNumber number, VersionNumber base, int start_ms, Incarnation incarnation = kFirst) {
  return {kRobot, incarnation, number, base, Trajectory::resting(at(start_ms), kStart)};
}

Firmware firmware() { return {kRobot, kStart, 0.5, kBegin, {}}; }

// Decodes a message as the simulator's node does.
void receive(Firmware& robot, const msg::Command& message, Time now) {
  if (const auto command = decode(message, kRobot, now))
    robot.on_command(*command, now);
  else
    robot.on_malformed_command(now);
}

TEST_CASE("a robot without commands executes version 0 at rest at its start position") {
  auto robot = firmware();
  const auto robot_report = robot.robot_report(at(5));
  CHECK(robot_report.robot == kRobot);
  CHECK(robot_report.obeyed_incarnation == 0);
  CHECK_FALSE(robot_report.command);
  CHECK(robot_report.executing.number == 0);
  CHECK(robot_report.executing.trajectory.at_start().position_m == kStart);
  CHECK(robot_report.executing.trajectory.phases().empty());
  CHECK(robot_report.heading_rad == 0.5);
}

TEST_CASE("a robot switches to a version on its current base at the start time and not earlier") {
  auto robot = firmware();
  robot.on_command(command_with(version(101, 0, 20)), at(5));
  CHECK(robot.robot_report(at(19)).executing.number == 0);
  CHECK(robot.robot_report(at(20)).executing.number == 101);
  CHECK(robot.counts().activated == 1);
}

TEST_CASE("an own stop does not contradict a fact reported for the same time") {
  const Time begin = time_from_ns(1'000'000'000), reported = begin + std::chrono::milliseconds(10);
  Firmware firmware(0, {0, 0}, 0, begin, {});
  firmware.reboot();
  REQUIRE(firmware.robot_report(reported).executing.number == 0);
  firmware.tick(reported, Odometry{});
  CHECK(firmware.executing().number == 0);
  firmware.tick(reported + kPhysicsStep, Odometry{});
  CHECK(firmware.is_off_reference());
}

TEST_CASE("a version that arrives after its start time is refused") {
  auto robot = firmware();
  robot.on_command(command_with(version(101, 0, 20)), at(21));
  robot.on_command(command_with(version(102, 0, 22)), at(22));
  CHECK(robot.robot_report(at(30)).executing.number == 0);
  CHECK(robot.counts().refused_late == 2);
  CHECK(robot.counts().activated == 0);
}

TEST_CASE("a version on another base is refused") {
  auto robot = firmware();
  robot.on_command(command_with(version(103, 102, 20)), at(5));
  CHECK(robot.robot_report(at(30)).executing.number == 0);
  CHECK(robot.counts().refused_base == 1);
}

TEST_CASE("the base of a version may arrive after the version") {
  auto robot = firmware();
  robot.on_command(command_with(version(102, 101, 40)), at(5));
  robot.on_command(command_with(version(101, 0, 20)), at(6));
  CHECK(robot.robot_report(at(39)).executing.number == 101);
  CHECK(robot.robot_report(at(40)).executing.number == 102);
}

TEST_CASE("only one of two versions on the same base is executed") {
  auto robot = firmware();
  robot.on_command(command_with(version(102, 0, 30)), at(5));
  robot.on_command(command_with(version(101, 0, 20)), at(6));
  CHECK(robot.robot_report(at(50)).executing.number == 101);
  CHECK(robot.counts().activated == 1);
  CHECK(robot.counts().refused_base == 1);
}

TEST_CASE("a version older than the executed one is never executed") {
  auto robot = firmware();
  robot.on_command(command_with(version(105, 0, 20)), at(5));
  REQUIRE(robot.switch_next(at(20)));
  robot.on_command(command_with(version(104, 105, 40)), at(25));
  CHECK(robot.robot_report(at(50)).executing.number == 105);
  CHECK(robot.counts().refused_base == 1);
}

TEST_CASE("a robot switches once to a repeated version and never refuses it") {
  auto robot = firmware();
  for (int ms = 5; ms < 30; ++ms) robot.on_command(command_with(version(101, 0, 20)), at(ms));
  CHECK(robot.counts().activated == 1);
  CHECK(robot.counts().refused_late == 0);
  CHECK(robot.counts().refused_base == 0);
}

TEST_CASE("versions in a chain that are due at the same time are executed in order of start") {
  auto robot = firmware();
  robot.on_command(command_with(version(103, 102, 30)), at(1));
  robot.on_command(command_with(version(101, 0, 10)), at(2));
  robot.on_command(command_with(version(102, 101, 20)), at(3));
  CHECK(robot.robot_report(at(100)).executing.number == 103);
  CHECK(robot.counts().activated == 3);
}

TEST_CASE("a version of a fenced, older incarnation is refused") {
  auto robot = firmware();
  robot.on_command(bare_command(kRobot, kSecond), at(1));
  robot.on_command(command_with(version(101, 0, 20, kFirst)), at(2));
  const auto robot_report = robot.robot_report(at(30));
  CHECK(robot_report.obeyed_incarnation == kSecond);
  CHECK(robot_report.executing.number == 0);
  CHECK(robot.counts().refused_fenced == 1);
}

TEST_CASE("a fence without a version drops pending versions of the older incarnation") {
  auto robot = firmware();
  robot.on_command(command_with(version(101, 0, 20, kFirst)), at(1));
  robot.on_command(bare_command(kRobot, kSecond), at(2));
  CHECK(robot.robot_report(at(30)).executing.number == 0);
  CHECK(robot.counts().refused_fenced == 1);
}

TEST_CASE("a fence does not affect the executed version") {
  auto robot = firmware();
  robot.on_command(command_with(version(101, 0, 20, kFirst)), at(1));
  robot.on_command(bare_command(kRobot, kSecond), at(20));
  const auto robot_report = robot.robot_report(at(30));
  CHECK(robot_report.executing.number == 101);
  CHECK(robot_report.executing.incarnation == kFirst);
  CHECK(robot_report.obeyed_incarnation == kSecond);
}

TEST_CASE("an agent cannot forward a version of an older incarnation") {
  auto robot = firmware();
  auto command = command_with(version(101, 0, 20, kFirst));
  command.incarnation = kSecond;
  robot.on_command(command, at(1));
  CHECK(robot.obeyed_incarnation() == kSecond);
  CHECK(robot.robot_report(at(30)).executing.number == 0);
  CHECK(robot.counts().refused_fenced == 1);
}

TEST_CASE(
    "a version under an older epoch is refused from any agent, and the robot reports its obeyed epoch") {
  auto robot = firmware();
  auto later = bare_command(kRobot, kFirst);
  later.epoch = 9;
  robot.on_command(later, at(1));
  CHECK(robot.robot_report(at(2)).obeyed_epoch == 9);
  auto old = command_with(version(101, 0, 20, kFirst));
  old.epoch = 8;
  robot.on_command(old, at(3));
  auto successor = command_with(version(201, 0, 20, kSecond));
  successor.epoch = 8;
  robot.on_command(successor, at(4));
  const auto robot_report = robot.robot_report(at(30));
  CHECK(robot_report.executing.number == 0);
  CHECK(robot_report.obeyed_epoch == 9);
  // The robot obeys the successor's incarnation but refuses its version.
  CHECK(robot_report.obeyed_incarnation == kSecond);
  CHECK(robot.counts().refused_fenced == 2);
}

TEST_CASE("a fenced agent cannot raise the epoch") {
  auto robot = firmware();
  robot.on_command(bare_command(kRobot, kSecond), at(1));
  auto zombie = bare_command(kRobot, kFirst);
  zombie.epoch = 9;
  robot.on_command(zombie, at(2));
  CHECK(robot.robot_report(at(3)).obeyed_epoch == 0);
}

TEST_CASE("a new incarnation continues from the executed version") {
  auto robot = firmware();
  robot.on_command(command_with(version(101, 0, 20, kFirst)), at(1));
  robot.on_command(bare_command(kRobot, kSecond), at(25));
  robot.on_command(command_with(version(201, 101, 40, kSecond)), at(30));
  CHECK(robot.robot_report(at(40)).executing.number == 201);
}

TEST_CASE("a robot always reports whether it has ever executed a granted version, not counting own stops") {
  auto robot = firmware();
  robot.reboot();
  (void)robot.tick(at(5), {});
  const VersionNumber stop = robot.robot_report(at(6)).executing.number;
  CHECK(stop > 0);
  CHECK_FALSE(robot.robot_report(at(7)).has_moved);
  robot.on_command(command_with(version(stop + 1, stop, 2000)), at(1900));
  CHECK_FALSE(robot.robot_report(at(1999)).has_moved);
  CHECK(robot.robot_report(at(2000)).has_moved);
  robot.reboot();
  (void)robot.tick(at(2005), {});
  CHECK(robot.robot_report(at(2006)).executing.number > stop + 1);
  CHECK(robot.robot_report(at(2007)).has_moved);
}

TEST_CASE("a due switch is made before a fact is reported") {
  SECTION("a report makes the switch") {
    auto robot = firmware();
    robot.on_command(command_with(version(101, 0, 20)), at(5));
    const auto robot_report = robot.robot_report(at(20));
    CHECK(robot_report.executing.number == 101);
    CHECK(robot_report.activated == 1);
  }
  SECTION("a command makes the switch") {
    auto robot = firmware();
    robot.on_command(command_with(version(101, 0, 20)), at(5));
    robot.on_command(bare_command(kRobot, kSecond), at(20));
    CHECK(robot.executing().number == 101);
  }
  SECTION("a malformed command makes the switch") {
    auto robot = firmware();
    robot.on_command(command_with(version(101, 0, 20)), at(5));
    robot.on_malformed_command(at(20));
    CHECK(robot.executing().number == 101);
  }
  SECTION("the control loop makes the switch") {
    auto robot = firmware();
    robot.on_command(command_with(version(101, 0, 20)), at(5));
    for (int ms = 1; ms <= 20; ++ms) robot.tick(at(ms), {});
    CHECK(robot.executing().number == 101);
  }
}

TEST_CASE("hostile commands change nothing and are counted") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<std::function<void(msg::Command&)>> corruptions{
      [](auto& c) { c.robot(kRobot + 1); },
      [](auto& c) { c.header().sender(kRobot + 1); },
      [](auto& c) { c.header().incarnation(0); },
      [nan](auto& c) { c.desired_heading_rad(nan); },
      [infinite](auto& c) { c.desired_heading_rad(infinite); },
      [](auto& c) { c.version().robot(kRobot + 1); },
      [](auto& c) { c.version().version_number(0); },
      [](auto& c) { c.version().incarnation(kSecond + 1); },
      [nan](auto& c) { c.version().x_m(nan); },
      [infinite](auto& c) { c.version().vy_mps(infinite); },
      [](auto& c) { c.version().phase_count(5); },
      [](auto& c) { c.version().phase_count(255); },
      [](auto& c) {
        c.version().phase_count(1);
        c.version().phases()[0].duration_ns(-1);
      },
      [nan](auto& c) {
        c.version().phase_count(1);
        c.version().phases()[0].ax_mps2(nan);
      },
      [nan](auto& c) {
        c.has_fix(true);
        c.fix().x_m(nan);
      },
      [](auto& c) {
        c.has_fix(true);
        c.fix().y_m(1e300);
      },
      [infinite](auto& c) {
        c.has_fix(true);
        c.fix().heading_rad(infinite);
      }};
  for (std::size_t i = 0; i < corruptions.size(); ++i) {
    CAPTURE(i);
    auto robot = firmware();
    robot.on_command(command_with(version(101, 0, 20, kFirst)), at(1));
    msg::Command hostile = encode(command_with(version(102, 0, 10, kSecond)));
    corruptions[i](hostile);
    receive(robot, hostile, at(5));
    CHECK(robot.counts().refused_malformed == 1);
    CHECK(robot.obeyed_incarnation() == kFirst);
    CHECK(robot.robot_report(at(15)).executing.number == 0);
    const auto robot_report = robot.robot_report(at(20));
    CHECK(robot_report.executing.number == 101);
    CHECK(robot_report.estimate.position_m == kStart);
    CHECK(robot_report.tracking_error_m == 0);
  }
}

TEST_CASE("a robot with NaN odometry brakes and stays silent until a fix shows it at rest") {
  const double bad = std::numeric_limits<double>::quiet_NaN();
  auto robot = firmware();
  for (int ms = 1; ms < 10; ++ms) (void)robot.tick(at(ms), {});
  const Odometry spoilt =
      GENERATE_COPY(Odometry{Vec2(bad, 0), 0}, Odometry{Vec2(0, bad), 0}, Odometry{Vec2(0, 0), bad});
  for (int ms = 10; ms < 20; ++ms) {
    const Actuation actuation = robot.tick(at(ms), spoilt);
    CHECK(actuation.acceleration_mps2.allFinite());
    CHECK(std::isfinite(actuation.angular_acceleration_radps2));
    CHECK_FALSE(robot.may_report());
  }
  auto seen = bare_command(kRobot, kFirst);
  seen.fix = PoseFix{at(25), Vec2(3, 4), 0.5};
  for (int ms = 20; ms < 200; ++ms) (void)robot.tick(at(ms), {});
  robot.on_command(seen, at(200));
  CHECK_FALSE(robot.may_report());  // the robot may have been moving at the time of the fix
  seen.fix->captured_at = at(190);
  robot.on_command(seen, at(201));
  (void)robot.tick(at(202), {});
  REQUIRE(robot.may_report());
  CHECK(robot.is_off_reference());
  CHECK((robot.position_m() - Vec2(3, 4)).norm() < 1e-6);
}

TEST_CASE("versions that start far ahead do not replace a version that starts soon") {
  auto robot = firmware();
  for (VersionNumber n = 0; n < 50; ++n) robot.on_command(command_with(version(200 + n, 0, 100'000)), at(1));
  robot.on_command(command_with(version(101, 0, 20)), at(2));
  CHECK(robot.robot_report(at(20)).executing.number == 101);
}

TEST_CASE("a robot turns to the commanded heading and holds it") {
  auto robot = firmware();
  Body body(kStart, 0.5, {});
  double before = 0.5;
  const auto run = [&](int from_ms, int to_ms) {
    for (int ms = from_ms + 1; ms <= to_ms; ++ms) {
      const double turning = wrapped_rad(body.heading_rad() - before) / kPhysicsStepSeconds;
      before = body.heading_rad();
      body.step(robot.tick(at(ms), {Vec2(0, 0), turning}));
    }
  };
  run(0, 1000);
  CHECK(std::abs(body.heading_rad() - 0.5) < 1e-6);
  auto command = bare_command(kRobot, kFirst);
  command.desired_heading_rad = -2.5;
  robot.on_command(command, at(1000));
  run(1000, 3000);
  CHECK(std::abs(wrapped_rad(body.heading_rad() + 2.5)) < 0.01);
}

// Sends random commands: late, duplicated, out of order, and from several incarnations. All versions rest at
// the start position, so that any may follow any other and only the rules decide.
TEST_CASE("the monitor finds no broken rule under random commands") {
  const std::uint64_t seed = GENERATE(range<std::uint64_t>(1, 40));
  CAPTURE(seed);
  Rng rng(seed);
  auto robot = firmware();
  FirmwareMonitor monitor(robot.executing());
  const auto switch_due = [&](Time now) {
    while (robot.switch_next(now)) monitor.switched(robot.executing());
  };
  VersionNumber newest = 100;
  std::uint64_t taken = 0;
  for (int us = 0; us < 3'000'000; us += static_cast<int>(1 + rng.below(4000))) {
    const Time now = kBegin + std::chrono::microseconds(us);
    if (rng.chance(0.5)) {
      const Incarnation incarnation = 100 + static_cast<Incarnation>(us / 500'000) - rng.below(2);
      const VersionNumber number = newest - rng.below(4);
      newest += rng.below(3);
      const VersionNumber base = rng.chance(0.6) ? robot.executing().number : newest - rng.below(6);
      Version v = version(number, base, us / 1000 + static_cast<int>(rng.below(20)) - 4, incarnation);
      auto command = rng.chance(0.9) ? command_with(v) : bare_command(kRobot, incarnation);
      switch_due(now);
      monitor.command_arrived(command, now);
      robot.on_command(command, now);
    } else {
      switch_due(now);
      const auto robot_report = robot.robot_report(now);
      monitor.reported(robot_report);
      taken = robot_report.activated;
    }
  }
  CHECK(monitor.violations() == 0);
  CHECK(taken > 20);
  CHECK(robot.counts().refused_late > 0);
  CHECK(robot.counts().refused_base > 0);
  CHECK(robot.counts().refused_fenced > 0);
}

}  // namespace sidestep::firmware_test
