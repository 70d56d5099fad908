// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/firmware_monitor.hpp"

#include "tests/catch.hpp"
#include "tests/unit/simulator/world/commands.hpp"

namespace sidestep::firmware_monitor_test {

using std::chrono::milliseconds;
using test::command_with;

constexpr RobotId kRobot = 3;
const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

Version version(VersionNumber number, VersionNumber base, int start_ms, Incarnation incarnation = 1) {
  return {kRobot, incarnation, number, base,
          Trajectory::resting(kBegin + milliseconds(start_ms), Vec2::Zero())};
}

struct Scene {
  FirmwareMonitor monitor{version(0, 0, 0, 0)};

  void arrive(const Version& v, int ms) {
    monitor.command_arrived(command_with(v), kBegin + milliseconds(ms));
  }
  void report(const Version& executing, int ms, Incarnation obeyed = 1) {
    RobotReport robot_report;
    robot_report.executing = executing;
    robot_report.valid_at = kBegin + milliseconds(ms);
    robot_report.obeyed_incarnation = obeyed;
    monitor.reported(robot_report);
  }
};

TEST_CASE("a firmware that keeps the rules causes no violations") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.monitor.switched(version(5, 0, 20));
  scene.report(version(5, 0, 20), 21);
  scene.arrive(version(6, 5, 40), 30);
  scene.arrive(version(6, 5, 40), 50);
  scene.monitor.switched(version(6, 5, 40));
  CHECK(scene.monitor.violations() == 0);
}

TEST_CASE("a switch from a version other than the base is a violation") {
  Scene scene;
  scene.arrive(version(5, 4, 20), 10);
  scene.monitor.switched(version(5, 4, 20));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a switch to a version that arrived after its start is a violation") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 20);
  scene.monitor.switched(version(5, 0, 20));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a switch to a version that never arrived is a violation") {
  Scene scene;
  scene.arrive(version(5, 0, 21), 10);
  scene.monitor.switched(version(5, 0, 20));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a switch back to an older number is a violation") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.monitor.switched(version(5, 0, 20));
  scene.arrive(version(4, 5, 40), 30);
  scene.monitor.switched(version(4, 5, 40));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a switch to an incarnation older than an acknowledged one is a violation") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.report(version(0, 0, 0, 0), 11, 2);
  scene.monitor.switched(version(5, 0, 20));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a switch that makes an earlier fact untrue is a violation") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.report(version(0, 0, 0, 0), 20);
  scene.monitor.switched(version(5, 0, 20));
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a report of a version that is not executed is a violation") {
  Scene scene;
  scene.report(version(5, 0, 20), 30);
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a jump of the reference is a violation") {
  const Vec2 jump = GENERATE(Vec2(0.0011, 0), Vec2(0, -0.2));
  Scene scene;
  Version v = version(5, 0, 20);
  v.trajectory = Trajectory::resting(v.trajectory.start(), jump);
  scene.arrive(v, 10);
  scene.monitor.switched(v);
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a jump of the reference's velocity is a violation") {
  Scene scene;
  Version v = version(5, 0, 20);
  Trajectory moving(v.trajectory.start(), {{0, 0}, {0.06, 0}});
  append_stop(moving, 5);
  v.trajectory = moving;
  scene.arrive(v, 10);
  scene.monitor.switched(v);
  CHECK(scene.monitor.violations() == 1);
}

// The firmware's own stop after 20 ms, `off_m` away from the rest version that the robot executes.
Version own_stop(double off_m, double speed_mps) {
  Version v = version(1 << 20, 0, 20, 0);
  v.trajectory = Trajectory(v.trajectory.start(), {{off_m, 0}, {0, speed_mps}});
  append_stop(v.trajectory, 5);
  v.inflation_m = 0.002;
  return v;
}

TEST_CASE("an own stop that follows the rules is not a violation") {
  Scene scene;
  // A slow own stop takes only a few nanoseconds.
  const double speed = GENERATE(0.0, 1e-9, 4e-9, 1e-8, 3e-7, 1e-5, 1.0);
  const Version stop = own_stop(0.01, speed);
  scene.monitor.started_own_stop(stop);
  RobotReport robot_report;
  robot_report.executing = stop;
  robot_report.is_off_reference = true;
  robot_report.valid_at = kBegin + milliseconds(21);
  scene.monitor.reported(robot_report);
  Version onwards = version((1 << 20) + 1, 1 << 20, 400);
  onwards.trajectory = Trajectory::resting(onwards.trajectory.start(), stop.trajectory.rest_position_m());
  scene.arrive(onwards, 30);
  scene.monitor.switched(onwards);
  scene.report(onwards, 401);
  CHECK(scene.monitor.violations() == 0);
}

TEST_CASE("an own stop that breaks a rule is a violation") {
  Scene scene;
  Version stop = own_stop(0.01, 1);
  SECTION("an own stop on the reference") { stop = own_stop(0.001, 1); }
  SECTION("an own stop numbered below a received version") { scene.arrive(version(1 << 21, 7, 50), 10); }
  SECTION("an own stop numbered below a received incarnation") {
    scene.arrive(version(5, 7, 50, 1 << 21), 10);
  }
  SECTION("an own stop on another base") { stop.base = 3; }
  SECTION("an own stop of an incarnation that no agent has") { stop.incarnation = 9; }
  SECTION("an own stop that makes a fact untrue") { scene.report(version(0, 0, 0, 0), 20, 0); }
  SECTION("an own stop that does not brake") {
    stop.trajectory = Trajectory(stop.trajectory.start(), {{0.01, 0}, {0, 1}});
  }
  SECTION("an own stop that brakes too little") {
    stop.trajectory = Trajectory(stop.trajectory.start(), {{0.01, 0}, {0, 1}});
    append_stop(stop.trajectory, 4);
  }
  SECTION("an own stop that turns") {
    stop.trajectory = Trajectory(stop.trajectory.start(), {{0.01, 0}, {0, 1}});
    stop.trajectory.append(milliseconds(200), Vec2(0.1, -5));
  }
  SECTION("an own stop with an inflation beyond the limit") { stop.inflation_m = 2; }
  SECTION("an own stop while lifted") { scene.monitor.lifted(); }
  scene.monitor.started_own_stop(stop);
  CHECK(scene.monitor.violations() >= 1);
}

TEST_CASE("a report of a false state is a violation") {
  Scene scene;
  RobotReport robot_report;
  robot_report.executing = version(0, 0, 0, 0);
  robot_report.valid_at = kBegin + milliseconds(21);
  SECTION("off reference while on reference") { robot_report.is_off_reference = true; }
  SECTION("lifted while on the floor") { robot_report.is_lifted = true; }
  SECTION("on the floor while lifted") { scene.monitor.lifted(); }
  SECTION("a command received in the future") {
    robot_report.command = {kBegin, robot_report.valid_at + Duration{1}};
  }
  scene.monitor.reported(robot_report);
  CHECK(scene.monitor.violations() == 1);
}

TEST_CASE("a lifted robot executes one rest version at any place and nothing else") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.monitor.switched(version(5, 0, 20));
  scene.monitor.lifted();
  SECTION("a rest version") {
    Version rest_version = version(6, 0, 40);
    rest_version.trajectory = Trajectory::resting(rest_version.trajectory.start(), {3, 3});
    scene.arrive(rest_version, 30);
    scene.monitor.switched(rest_version);
    scene.monitor.put_down();
    CHECK(scene.monitor.violations() == 0);
  }
  SECTION("a lower number") {
    scene.arrive(version(4, 0, 40), 30);
    scene.monitor.switched(version(4, 0, 40));
    CHECK(scene.monitor.violations() == 1);
  }
  SECTION("a moving version") {
    Version dash = version(6, 0, 40);
    dash.trajectory.append(milliseconds(10), {1, 0});
    append_stop(dash.trajectory, 5);
    scene.arrive(dash, 30);
    scene.monitor.switched(dash);
    CHECK(scene.monitor.violations() == 1);
  }
  SECTION("put down without a rest version") {
    scene.monitor.put_down();
    CHECK(scene.monitor.violations() == 1);
  }
}

}  // namespace sidestep::firmware_monitor_test
