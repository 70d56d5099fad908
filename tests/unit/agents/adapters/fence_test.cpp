// SPDX-License-Identifier: Apache-2.0
// New agents fence a robot whose motors obey late and have already been sent the beginning of a pending
// version.
#include <algorithm>
#include <vector>

#include "tests/catch.hpp"
#include "tests/unit/agents/adapters/driven_scene.hpp"

namespace sidestep::fence_test {
namespace {

using namespace std::chrono_literals;
using test::beyond_m;
using test::continuation;
using test::DrivenScene;

constexpr double kTrackingBound_m = SafetyBudget{}.tracking_bound_m;

/// Runs for `duration`. Returns the body's maximum deviation from the executed version, minus the inflation.
double run_and_measure(DrivenScene& scene, Duration duration) {
  double largest_m = 0;
  for (const Time end = scene.now + duration; scene.now < end;) {
    scene.step();
    largest_m = std::max(largest_m, beyond_m(scene.robot_report().executing, scene.position_m, scene.now));
  }
  return largest_m;
}

/// A robot at rest with a pending version that starts 30 ms after the latency.
struct PendingScene : DrivenScene {
  explicit PendingScene(Duration latency) : DrivenScene(latency) {
    run(1500ms);
    REQUIRE(robot.may_report());
    base = robot_report().executing;
    start = now + latency + 30ms;
    pending = continuation(base, agent, base.number + 1, start, Vec2(3, 0), 500ms);
    send(pending);
  }
  Version base, pending;
  Time start{};
};

}  // namespace

TEST_CASE("a new agent does not make a robot leave the version that it executes") {
  const Duration latency = GENERATE(0ms, 10ms, 50ms, 100ms, 200ms, 300ms);
  const Duration before_start = GENERATE(10ms, 20ms, 50ms, 150ms, 290ms);
  if (before_start > latency) return;
  INFO("latency " << to_seconds(latency) << " s, fenced " << to_seconds(before_start)
                  << " s before the start");
  PendingScene scene(latency);
  scene.run(scene.start - before_start - scene.now);
  scene.agent = 101;
  scene.send(std::nullopt);
  // The motors have already received the beginning of the pending version, so the robot keeps it and
  // acknowledges the new agent only when that version starts.
  CHECK(scene.robot_report().obeyed_incarnation == 100);
  CHECK_FALSE(scene.robot_report().command);
  CHECK(scene.robot.side().obeyed_incarnation() == 101);
  double beyond = run_and_measure(scene, scene.start - 10ms - scene.now);
  CHECK(scene.robot_report().obeyed_incarnation == 100);
  beyond = std::max(beyond, run_and_measure(scene, 10ms));
  const RobotReport robot_report = scene.robot_report();
  CHECK(robot_report.executing.number == scene.pending.number);
  CHECK(robot_report.obeyed_incarnation == 101);
  CHECK(robot_report.command);
  beyond = std::max(beyond, run_and_measure(scene, 1500ms));
  CHECK(beyond <= kTrackingBound_m);
  CHECK(scene.robot.side().own_stops() == 1);
}

TEST_CASE(
    "a version that starts later than the lead is discarded and the new agent is acknowledged immediately") {
  const Duration latency = GENERATE(0ms, 50ms, 300ms);
  PendingScene scene(latency);
  scene.run(10ms);
  scene.agent = 101;
  scene.send(std::nullopt);
  CHECK(scene.robot_report().obeyed_incarnation == 101);
  CHECK_FALSE(scene.robot.side().has_pending());
  CHECK(run_and_measure(scene, 1500ms) <= kTrackingBound_m);
  CHECK(scene.robot_report().executing.number == scene.base.number);
}

TEST_CASE("a fenced robot keeps the versions of a chain that start within the lead") {
  PendingScene scene(200ms);
  scene.run(10ms);
  // The robot will not execute `third`, which starts too late, or `other`, which has a different base.
  Version second =
      continuation(scene.pending, 100, scene.pending.number + 1, scene.start + 50ms, Vec2(0, 3), 300ms);
  Version third = continuation(second, 100, second.number + 1, scene.start + 150ms, Vec2(0, -3), 300ms);
  Version other = continuation(scene.base, 100, third.number + 1, scene.start + 20ms, Vec2(-3, 0), 300ms);
  for (const Version& version : {second, third, other}) scene.send(version);
  scene.run(scene.start - 110ms - scene.now);
  scene.agent = 101;
  scene.send(std::nullopt);
  CHECK(scene.robot.side().counts().refused_fenced == 2);
  const Time acknowledged_at = second.trajectory.start();
  double beyond = run_and_measure(scene, acknowledged_at - 10ms - scene.now);
  CHECK(scene.robot_report().executing.number == scene.pending.number);
  CHECK(scene.robot_report().obeyed_incarnation == 100);
  beyond = std::max(beyond, run_and_measure(scene, 10ms));
  CHECK(scene.robot_report().executing.number == second.number);
  CHECK(scene.robot_report().obeyed_incarnation == 101);
  beyond = std::max(beyond, run_and_measure(scene, 1500ms));
  CHECK(scene.robot_report().executing.number == second.number);
  CHECK(beyond <= kTrackingBound_m);
}

TEST_CASE("agents that fence a robot in turn delay each other by no more than the lead") {
  PendingScene scene(300ms);
  scene.run(scene.start - 290ms - scene.now);
  const Time fenced = scene.now;
  double beyond = 0;
  while (scene.robot_report().obeyed_incarnation == 100) {
    ++scene.agent;
    // Each agent sends a version that would continue the pending one.
    scene.send(continuation(scene.pending, scene.agent, scene.pending.number + scene.agent, scene.now + 310ms,
                            Vec2(0, 3), 100ms));
    beyond = std::max(beyond, run_and_measure(scene, 10ms));
    REQUIRE(scene.now - fenced <= 300ms);
  }
  CHECK(scene.robot_report().obeyed_incarnation == scene.agent);
  CHECK(scene.robot_report().executing.number == scene.pending.number);
  beyond = std::max(beyond, run_and_measure(scene, 1500ms));
  CHECK(beyond <= kTrackingBound_m);
}

TEST_CASE("a robot obeys a new epoch immediately, but its agent only when the pending version starts") {
  PendingScene scene(100ms);
  scene.run(scene.start - 50ms - scene.now);
  scene.agent = 101;
  scene.epoch = 9;
  scene.send(std::nullopt);
  CHECK(scene.robot_report().obeyed_incarnation == 100);
  CHECK(scene.robot_report().obeyed_epoch == 9);
  CHECK(run_and_measure(scene, 1500ms) <= kTrackingBound_m);
  CHECK(scene.robot_report().obeyed_incarnation == 101);
  CHECK(scene.robot_report().executing.number == scene.pending.number);
}

namespace {

/// The versions that other processes expect the robot to execute according to the rules of the ledger.
class ExpectedVersions {
 public:
  void grant(const Version& version) { versions_.push_back(version); }
  /// Applies a fact. Returns false if the fact contradicts the expected versions.
  bool apply(const RobotReport& robot_report) {
    const VersionNumber f = robot_report.executing.number;
    const auto is_f = [=](const Version& version) { return version.number == f; };
    const auto is_older = [=](const Version& version) { return version.number < f; };
    if (std::ranges::none_of(versions_, is_f)) {
      if (!robot_report.is_off_reference || !std::ranges::all_of(versions_, is_older)) return false;
      versions_ = {robot_report.executing};
    }
    std::erase_if(versions_, [&](const Version& version) {
      return version.number < f ||
             (version.number > f && version.trajectory.start() <= robot_report.valid_at);
    });
    return true;
  }

 private:
  std::vector<Version> versions_;
};

}  // namespace

TEST_CASE("a robot with agents that restart at random executes and follows only expected versions") {
  int restarts = 0, deferred = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    INFO("seed " << seed);
    Rng rng(seed);
    const Duration latency = 1ms * static_cast<int>(rng.below(301));
    DrivenScene scene(latency);
    ExpectedVersions expected;
    scene.run(1200ms);
    Incarnation acknowledged = 0;
    VersionNumber begun_with = 0, number = 0;
    Version last;
    bool is_waiting = false;
    double beyond = 0;
    for (Time next = scene.now, end = scene.now + 4s; scene.now < end; scene.step()) {
      const RobotReport robot_report = scene.robot_report();
      REQUIRE(expected.apply(robot_report));
      beyond = std::max(beyond, beyond_m(robot_report.executing, scene.position_m, scene.now));
      if (robot_report.obeyed_incarnation != acknowledged) {
        acknowledged = robot_report.obeyed_incarnation;
        begun_with = robot_report.executing.number;
        last = robot_report.executing;
        next = scene.now;
      }
      // The robot executes only what the acknowledgement stated, and versions of the acknowledged agent.
      REQUIRE((robot_report.executing.incarnation == acknowledged ||
               robot_report.executing.number == begun_with));
      if (is_waiting && acknowledged == scene.agent) is_waiting = false;
      const bool has_restarted = rng.chance(0.04), is_twin = rng.chance(0.3);
      if (has_restarted) {
        scene.agent += 1 + rng.below(3);
        ++restarts;
        scene.send(std::nullopt);
        is_waiting = scene.robot_report().obeyed_incarnation != scene.agent;
        deferred += is_waiting;
      }
      // An agent that the robot no longer obeys may keep running.
      const bool is_alive = acknowledged == scene.agent || is_twin;
      if (!is_alive || scene.now < next) continue;
      const Duration ahead = latency + 10ms + from_seconds(rng.uniform(0, 0.03));
      const double size_mps2 = rng.uniform(0, 5), angle_rad = rng.uniform(-3.14, 3.14);
      number = std::max(number, last.number) + 1;
      last = continuation(last, acknowledged, number, scene.now + ahead,
                          rotated(Vec2(size_mps2, 0), angle_rad), ahead);
      expected.grant(last);
      Command command = scene.bare();
      command.incarnation = acknowledged;
      command.version = last;
      scene.robot.on_command(command, scene.now, scene.memory);
      next = last.trajectory.start();
    }
    CHECK(beyond <= kTrackingBound_m);
    CHECK(scene.robot.side().own_stops() == 1);
  }
  CHECK(restarts > 3000);
  CHECK(deferred > 500);
}

}  // namespace sidestep::fence_test
