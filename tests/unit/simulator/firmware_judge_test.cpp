// SPDX-License-Identifier: Apache-2.0
#include "simulator/firmware_judge.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/simulator/commands.hpp"

namespace sidestep {
namespace {

using std::chrono::milliseconds;
using test::command_with;

constexpr RobotId kRobot = 3;
const Time kBegin = time_from_ns(1'700'000'000'000'000'000);

Version version(VersionNumber number, VersionNumber base, int start_ms, Incarnation incarnation = 1) {
  return {kRobot, incarnation, number, base,
          Trajectory::resting(kBegin + milliseconds(start_ms), Vec2::Zero())};
}

struct Scene {
  FirmwareJudge judge{version(0, 0, 0, 0)};

  void arrive(const Version& v, int ms) { judge.command_arrived(command_with(v), kBegin + milliseconds(ms)); }
  void report(const Version& executing, int ms, Incarnation obeyed = 1) {
    msg::Feedback fact;
    fact.executing(encode(executing));
    fact.at_ns(to_ns(kBegin + milliseconds(ms)));
    fact.obeyed_incarnation(obeyed);
    judge.reported(fact);
  }
};

TEST_CASE("a firmware that keeps the rules is not blamed") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.judge.switched(version(5, 0, 20));
  scene.report(version(5, 0, 20), 21);
  scene.arrive(version(6, 5, 40), 30);
  scene.arrive(version(6, 5, 40), 50);
  scene.judge.switched(version(6, 5, 40));
  CHECK(scene.judge.violations() == 0);
}

TEST_CASE("a switch from another version than the base is counted") {
  Scene scene;
  scene.arrive(version(5, 4, 20), 10);
  scene.judge.switched(version(5, 4, 20));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a switch to a version that came after its start is counted") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 20);
  scene.judge.switched(version(5, 0, 20));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a switch to a version that never came is counted") {
  Scene scene;
  scene.arrive(version(5, 0, 21), 10);
  scene.judge.switched(version(5, 0, 20));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a switch back to an older number is counted") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.judge.switched(version(5, 0, 20));
  scene.arrive(version(4, 5, 40), 30);
  scene.judge.switched(version(4, 5, 40));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a switch to an incarnation older than an acknowledged one is counted") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.report(version(0, 0, 0, 0), 11, 2);
  scene.judge.switched(version(5, 0, 20));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a switch that makes an earlier fact untrue is counted") {
  Scene scene;
  scene.arrive(version(5, 0, 20), 10);
  scene.report(version(0, 0, 0, 0), 20);
  scene.judge.switched(version(5, 0, 20));
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a report of what is not executed is counted") {
  Scene scene;
  scene.report(version(5, 0, 20), 30);
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a reference that jumps is counted") {
  const Vec2 jump = GENERATE(Vec2(0.0011, 0), Vec2(0, -0.2));
  Scene scene;
  Version v = version(5, 0, 20);
  v.trajectory = Trajectory::resting(v.trajectory.start(), jump);
  scene.arrive(v, 10);
  scene.judge.switched(v);
  CHECK(scene.judge.violations() == 1);
}

TEST_CASE("a reference whose velocity jumps is counted") {
  Scene scene;
  Version v = version(5, 0, 20);
  Trajectory moving(v.trajectory.start(), {{0, 0}, {0.06, 0}});
  append_stop(moving, 5);
  v.trajectory = moving;
  scene.arrive(v, 10);
  scene.judge.switched(v);
  CHECK(scene.judge.violations() == 1);
}

}  // namespace
}  // namespace sidestep
