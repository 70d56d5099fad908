// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/driven_robot.hpp"

#include <functional>
#include <limits>

#include "tests/catch.hpp"
#include "tests/unit/agents/adapters/driven_scene.hpp"

namespace sidestep::driven_robot_test {

using namespace std::chrono_literals;
using test::kDrivenRobot;
using Scene = test::DrivenScene;

TEST_CASE(
    "a driven robot rests silently until fixes agree on its position, then reports its own stop there") {
  Scene scene;
  scene.sees = false;
  scene.run(1s);
  CHECK_FALSE(scene.robot.may_report());
  // The robot is moved between fixes, so the fixes disagree.
  for (int i = 0; i < 20; ++i) {
    scene.run(20ms);
    scene.position_m.x() += 0.05;
    scene.fix();
    CHECK_FALSE(scene.robot.may_report());
  }
  scene.sees = true;
  scene.run(100ms);
  REQUIRE(scene.robot.may_report());
  const RobotReport robot_report = scene.robot.robot_report(scene.now);
  CHECK(robot_report.is_off_reference);
  CHECK((robot_report.executing.trajectory.rest_position_m() - scene.position_m).norm() < 0.001);
  CHECK(robot_report.heading_rad == Approx(0.4).margin(0.01));
  CHECK(robot_report.lead == 100ms);
  CHECK_FALSE(robot_report.has_moved);
}

TEST_CASE("a driven robot follows a timely version to its end and turns as commanded") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  const Version base = scene.robot.robot_report(scene.now).executing;
  Command command = scene.bare();
  const Time start = scene.now + 150ms;
  Trajectory trajectory(start, base.trajectory.state_at(start));
  trajectory.append(500ms, Vec2(2, 1));
  append_stop(trajectory, 4);
  command.version = Version{kDrivenRobot, 100, base.number + 1, base.number, trajectory};
  command.desired_heading_rad = 2;
  scene.robot.on_command(command, scene.now, scene.memory);
  const auto turn = [&] {
    Command again = scene.bare();
    again.desired_heading_rad = 2;
    scene.robot.on_command(again, scene.now, scene.memory);
  };
  scene.sees = false;
  double max_error_m = 0;
  while (scene.now < trajectory.end() + 500ms) {
    scene.run(10ms);
    turn();
    const Vec2 reference_m =
        scene.robot.robot_report(scene.now).executing.trajectory.state_at(scene.now).position_m;
    max_error_m = std::max(max_error_m, (scene.position_m - reference_m).norm());
  }
  CHECK(max_error_m < 0.004);
  CHECK_FALSE(scene.robot.side().is_off_reference());
  CHECK((scene.position_m - trajectory.rest_position_m()).norm() < 0.003);
  CHECK(wrapped_rad(scene.heading_rad - 2) == Approx(0).margin(0.1));
}

TEST_CASE("a driven robot that is displaced makes an own stop where vision sees it") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  const VersionNumber before = scene.robot.robot_report(scene.now).executing.number;
  scene.position_m += Vec2(0.3, 0.2);
  scene.run(300ms);
  const RobotReport robot_report = scene.robot.robot_report(scene.now);
  CHECK(robot_report.is_off_reference);
  CHECK(robot_report.executing.number >= before + robot::RobotSide<float>::kOwnNumberGap);
  CHECK((robot_report.executing.trajectory.rest_position_m() - scene.position_m).norm() <
        robot_report.executing.inflation_m);
}

TEST_CASE("a driven robot whose process was paused stays at rest until it has found its pose again") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  scene.now += 400ms;
  scene.run(10ms);
  CHECK_FALSE(scene.robot.may_report());
  CHECK(scene.commanded.latest().linear_mps == Vec2(0, 0));
  scene.run(1s);
  CHECK(scene.robot.may_report());
  CHECK(scene.robot.robot_report(scene.now).is_off_reference);
}

namespace {

/// Sends a version that accelerates for a second and then stops. Calls `step` in each period. Returns the
/// largest error of the robot's own estimate, which is infinite if the robot falls silent.
double drive_and_measure(Scene& scene, const std::function<void()>& step) {
  const Version base = scene.robot_report().executing;
  const Time start = scene.now + 150ms;
  scene.send(test::continuation(base, scene.agent, base.number + 1, start, Vec2(1.2, 0.5), 1s));
  double largest_m = 0;
  for (const Time end = start + 1500ms; scene.now < end;) {
    step();
    if (!scene.robot.may_report()) return std::numeric_limits<double>::infinity();
    largest_m = std::max(largest_m, (scene.robot_report().estimate.position_m - scene.position_m).norm());
  }
  return largest_m;
}

}  // namespace

TEST_CASE("with odometry, a driven robot knows its position even if its base is slower than commanded") {
  // The timestamp of an odometry report may lie between two control periods.
  const auto [report_every, ago] = GENERATE(table<int, Duration>({{1, 0ms}, {1, 3ms}, {1, 7ms}, {2, 5ms}}));
  CAPTURE(report_every, ago.count());
  Scene scene;
  scene.desired_heading_rad = 2;  // the robot turns while it drives
  scene.run(1500ms);
  scene.desired_heading_rad = 0.4;
  // Dead reckoning from the commands alone would be off by 7 mm at the end.
  scene.obeyed_fraction = 0.995;
  scene.sees = false;
  int periods = 0;
  const auto report = [&] {
    scene.step();
    if (++periods % report_every == 0) scene.report_odometry(0ms, ago);
  };
  for (int i = 0; i < 20; ++i) report();
  CHECK(drive_and_measure(scene, report) < 0.001);
  CHECK(scene.robot.side().own_stops() == 1);
  CHECK(scene.robot.misdated_odometry() == 0);
}

TEST_CASE("fixes newer than the odometry are used once the odometry has arrived") {
  Scene scene;
  scene.run(1500ms);
  // The base is pushed, but its odometry does not show this.
  for (int i = 0; i < 10; ++i) {
    scene.step();
    scene.report_odometry();
  }
  const Vec2 push_m(0.004, 0);
  const Vec2 before_m = scene.robot_report().estimate.position_m;
  scene.position_m += push_m;
  for (int i = 0; i < 20; ++i) {
    scene.step();
    scene.robot.on_odometry({kDrivenRobot, scene.now, scene.position_m - push_m, scene.heading_rad},
                            scene.now);
  }
  CHECK((scene.robot_report().estimate.position_m - before_m - push_m).norm() < 0.001);
}

TEST_CASE("odometry with wrong timestamps is counted and does not mislead a driven robot") {
  const Duration timestamp_error = GENERATE(-150ms, -100ms, -40ms, -10ms, 10ms, 40ms, 100ms, 150ms);
  CAPTURE(timestamp_error.count());
  Scene scene;
  scene.run(1500ms);
  scene.sees = false;
  std::uint64_t reports = 0;
  const double error_m = drive_and_measure(scene, [&] {
    scene.step();
    scene.report_odometry(timestamp_error);
    ++reports;
  });
  CHECK(error_m < 0.002);
  CHECK(scene.robot.misdated_odometry() == reports);
  CHECK_FALSE(scene.robot.side().has_pending());
}

TEST_CASE("a base clock that is set back during the drive misleads the robot only briefly") {
  Scene scene;
  scene.run(1500ms);
  scene.sees = false;
  std::uint64_t reports = 0;
  const double error_m = drive_and_measure(scene, [&] {
    scene.step();
    scene.report_odometry(++reports > 50 ? -80ms : 0ms);
  });
  CHECK(error_m < 0.01);
  CHECK(scene.robot.misdated_odometry() > 50);
}

TEST_CASE("a driven robot is less certain of its position while its odometry is not trusted") {
  const auto error_after = [](Duration timestamp_error) {
    Scene scene;
    scene.run(1500ms);
    for (int i = 0; i < 150; ++i) {
      scene.sees = i < 50;
      scene.step();
      scene.report_odometry(timestamp_error);
    }
    return scene.robot_report().uncertainty.position_error_rms_m;
  };
  CHECK(error_after(100ms) > 3 * error_after(0ms));
}

TEST_CASE("a driven robot with NaN odometry stops and stays silent until it has found its pose") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Scene scene;
  scene.run(1500ms);
  const Version base = scene.robot_report().executing;
  const Time start = scene.now + 150ms;
  scene.send(test::continuation(base, scene.agent, base.number + 1, start, Vec2(2, 0), 300ms));
  scene.run(300ms);
  scene.robot.on_odometry({kDrivenRobot, scene.now, {0, 0}, 0}, scene.now);
  scene.step();
  scene.robot.on_odometry({kDrivenRobot, scene.now, {nan, 0}, 0}, scene.now);
  for (int i = 0; i < 20 && scene.robot.may_report(); ++i) scene.step();
  CHECK_FALSE(scene.robot.may_report());
  CHECK(scene.commanded.latest().linear_mps == Vec2(0, 0));
  scene.run(100ms);
  CHECK_FALSE(scene.robot.may_report());
  scene.run(1s);
  REQUIRE(scene.robot.may_report());
  CHECK(scene.robot_report().is_off_reference);
  CHECK((scene.robot_report().estimate.position_m - scene.position_m).norm() < 0.002);
}

}  // namespace sidestep::driven_robot_test
