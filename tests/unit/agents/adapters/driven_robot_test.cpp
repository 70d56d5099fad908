// SPDX-License-Identifier: Apache-2.0
#include "agents/adapters/driven_robot.hpp"

#include "tests/catch.hpp"
#include "tests/unit/common/robot/test_memory.hpp"

namespace sidestep::driven_robot_test {
namespace {

using namespace std::chrono_literals;

constexpr RobotId kRobot = 3;
const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

/// A driven robot whose base does exactly what it is commanded, after the latency.
struct Scene {
  explicit Scene(Duration latency = 100ms) { settings.latency = latency; }

  void run(Duration duration) {
    for (const Time end = now + duration; now < end;) {
      now += 10ms;
      const BodyVelocity command = robot.tick(now, memory);
      commanded.add(now, command);
      const BodyVelocity obeyed = commanded.mean(now - 10ms, now);
      position_m += 0.01 * rotated(obeyed.linear_mps, heading_rad + 0.005 * obeyed.turn_radps);
      heading_rad += 0.01 * obeyed.turn_radps;
      if (sees) fix();
    }
  }
  void fix() {
    Command command = bare();
    command.fix = PoseFix{now - 5ms, position_m, heading_rad};
    robot.on_command(command, now, memory);
  }
  Command bare() const {
    Command command;
    command.robot = kRobot;
    command.incarnation = 100;
    command.epoch = 1;
    command.sent_at = now;
    return command;
  }

  DriveSettings settings;
  Time now = kBegin;
  robot::test::TestMemory memory;
  DrivenRobot robot{kRobot, settings, {}, kBegin};
  CommandedMotion commanded{100ms};
  Vec2 position_m{1.5, -0.7};
  double heading_rad = 0.4;
  bool sees = true;
};

}  // namespace

TEST_CASE(
    "a driven robot stands and is silent until fixes agree on where it is, and then reports its own stop "
    "there") {
  Scene scene;
  scene.sees = false;
  scene.run(1s);
  CHECK_FALSE(scene.robot.may_report());
  // Fixes that do not agree.
  for (int i = 0; i < 20; ++i) {
    scene.run(20ms);
    scene.position_m.x() += 0.05;
    scene.fix();
    CHECK_FALSE(scene.robot.may_report());
  }
  scene.sees = true;
  scene.run(100ms);
  REQUIRE(scene.robot.may_report());
  const Feedback fact = scene.robot.feedback(scene.now);
  CHECK(fact.is_off_reference);
  CHECK((fact.executing.trajectory.rest_position_m() - scene.position_m).norm() < 0.001);
  CHECK(fact.heading_rad == Approx(0.4).margin(0.01));
  CHECK(fact.lead == 100ms);
  CHECK_FALSE(fact.has_moved);
}

TEST_CASE("a driven robot follows a version that comes in time to its end, turning as it is told") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  const Version base = scene.robot.feedback(scene.now).executing;
  Command command = scene.bare();
  const Time start = scene.now + 150ms;
  Trajectory trajectory(start, base.trajectory.state_at(start));
  trajectory.append(500ms, Vec2(2, 1));
  append_stop(trajectory, 4);
  command.version = Version{kRobot, 100, base.number + 1, base.number, trajectory};
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
        scene.robot.feedback(scene.now).executing.trajectory.state_at(scene.now).position_m;
    max_error_m = std::max(max_error_m, (scene.position_m - reference_m).norm());
  }
  CHECK(max_error_m < 0.004);
  CHECK_FALSE(scene.robot.side().is_off_reference());
  CHECK((scene.position_m - trajectory.rest_position_m()).norm() < 0.003);
  CHECK(wrapped_rad(scene.heading_rad - 2) == Approx(0).margin(0.1));
}

TEST_CASE("a driven robot that is moved makes its own stop where it is seen") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  const VersionNumber before = scene.robot.feedback(scene.now).executing.number;
  scene.position_m += Vec2(0.3, 0.2);
  scene.run(300ms);
  const Feedback fact = scene.robot.feedback(scene.now);
  CHECK(fact.is_off_reference);
  CHECK(fact.executing.number >= before + robot::RobotSide<float>::kOwnNumberGap);
  CHECK((fact.executing.trajectory.rest_position_m() - scene.position_m).norm() < fact.executing.inflation_m);
}

TEST_CASE("after a pause of its process a driven robot stands until it has found its pose again") {
  Scene scene;
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  scene.now += 400ms;
  scene.run(10ms);
  CHECK_FALSE(scene.robot.may_report());
  CHECK(scene.commanded.latest().linear_mps == Vec2(0, 0));
  scene.run(1s);
  CHECK(scene.robot.may_report());
  CHECK(scene.robot.feedback(scene.now).is_off_reference);
}

}  // namespace sidestep::driven_robot_test
