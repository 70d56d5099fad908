// SPDX-License-Identifier: Apache-2.0
// If a robot's motors obey late, its own stop includes the motion that is under way.
#include <algorithm>
#include <cstdlib>

#include "tests/catch.hpp"
#include "tests/unit/agents/adapters/driven_scene.hpp"

namespace sidestep::own_stop_test {
namespace {

using namespace std::chrono_literals;
using test::beyond_m;
using test::continuation;
using test::DrivenScene;

/// The robot's first own stop after version `before`, and the body's maximum deviation from this stop
/// within 1.5 s, minus the stop's inflation.
struct OwnStopDeviation {
  std::optional<Version> stop;
  double beyond_m = 0;

  void follow(DrivenScene& scene, VersionNumber before) {
    for (int i = 0; i < 150; ++i) {
      scene.step();
      const RobotReport robot_report = scene.robot_report();
      if (!stop && robot_report.is_off_reference && robot_report.executing.number != before)
        stop = robot_report.executing;
      if (stop) beyond_m = std::max(beyond_m, test::beyond_m(*stop, scene.position_m, scene.now));
    }
  }
};

constexpr double kTrackingBound_m = SafetyBudget{}.tracking_bound_m;

}  // namespace

TEST_CASE("a robot that is pushed just before a short version stays within its own stop") {
  const Duration latency = GENERATE(0ms, 50ms, 100ms, 150ms, 200ms, 300ms);
  DrivenScene scene(latency);
  scene.run(1500ms);
  REQUIRE(scene.robot.may_report());
  const Version base = scene.robot_report().executing;
  const Time start = scene.now + latency + 30ms;
  // The version ends when the motors begin to execute it.
  scene.send(continuation(base, scene.agent, base.number + 1, start, Vec2(3, 0), latency * 5 / 8 + 1ms));
  scene.run(start - 10ms - scene.now);
  REQUIRE(scene.robot_report().executing.number == base.number);
  scene.position_m += Vec2(0.006, 0);
  OwnStopDeviation excursion;
  excursion.follow(scene, base.number);
  INFO("latency " << to_seconds(latency) << " s");
  REQUIRE(excursion.stop);
  CHECK(excursion.beyond_m <= kTrackingBound_m);
}

namespace {

Duration random_latency(Rng& rng) {
  const Duration whole = 10ms * static_cast<int>(rng.below(31));
  const bool is_odd = rng.chance(0.5);
  const Duration part = from_seconds(rng.uniform(0, 0.01));
  return std::min<Duration>(is_odd ? whole + part : whole, CommandedMotion::kMaxLatency);
}

/// Drives a robot at random and pushes it once. nullopt if the robot made an own stop without a push.
std::optional<OwnStopDeviation> push_at_random(std::uint64_t seed) {
  Rng rng(seed);
  DrivenScene scene(random_latency(rng));
  const Duration latency = scene.commanded.latency();
  scene.run(1200ms);
  Version last = scene.robot_report().executing;
  const VersionNumber first_stop = last.number;
  const Time push_at = scene.now + from_seconds(rng.uniform(0, 2.5));
  Vec2 aim_mps2(0, 0);
  for (Time next = scene.now; scene.now < push_at; scene.step()) {
    if (scene.now < next) continue;
    // Agents typically propose a version this long before its start, with an acceleration of this duration.
    const Duration ahead = latency + 10ms + from_seconds(rng.uniform(0, 0.03));
    if (rng.chance(0.4)) {
      const double size_mps2 = rng.uniform(0, 5), angle_rad = rng.uniform(-3.14, 3.14);
      aim_mps2 = rotated(Vec2(size_mps2, 0), angle_rad);
    }
    if (rng.chance(0.3)) scene.desired_heading_rad = rng.uniform(-3.14, 3.14);
    last = continuation(last, scene.agent, last.number + 1, scene.now + ahead, aim_mps2, ahead);
    scene.send(last);
    next = last.trajectory.start() + (rng.chance(0.1) ? 300ms : 0ms);
  }
  if (scene.robot_report().is_off_reference && scene.robot_report().executing.number != first_stop)
    return std::nullopt;
  const VersionNumber before = scene.robot_report().executing.number;
  const double push_m = rng.uniform(0, 0.02), angle_rad = rng.uniform(-3.14, 3.14);
  scene.position_m += rotated(Vec2(push_m, 0), angle_rad);
  OwnStopDeviation excursion;
  excursion.follow(scene, before);
  return excursion;
}

void check_pushes(std::uint64_t first, std::uint64_t count) {
  std::uint64_t stops = 0, unprovoked = 0, beyond = 0, worst_seed = 0;
  double worst_m = 0, inflations_m = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const auto excursion = push_at_random(seed);
    unprovoked += !excursion;
    if (!excursion || !excursion->stop) continue;
    ++stops;
    inflations_m += excursion->stop->inflation_m;
    beyond += excursion->beyond_m > kTrackingBound_m;
    if (excursion->beyond_m > worst_m) worst_m = excursion->beyond_m, worst_seed = seed;
  }
  WARN(stops << " own stops, inflated by " << 1e3 * inflations_m / static_cast<double>(stops)
             << " mm on average; " << beyond << " left by the body, worst deviation " << 1e3 * worst_m
             << " mm, seed " << worst_seed << "; " << unprovoked << " stops without a push");
  CHECK(beyond == 0);
  CHECK(unprovoked == 0);
  CHECK(stops > count / 2);
}

}  // namespace

TEST_CASE("a pushed robot's body always stays within its own stop") { check_pushes(1, 2000); }

TEST_CASE("a pushed robot's body always stays within its own stop, for a hundred thousand pushes",
          "[.][slow]") {
  check_pushes(1'000'000, 100'000);
}

}  // namespace sidestep::own_stop_test
