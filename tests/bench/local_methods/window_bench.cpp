// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <fmt/core.h>

#include "agents/navigation/dynamic_window/disc_window.hpp"
#include "agents/navigation/dynamic_window/dynamic_window.hpp"
#include "tests/bench/local_methods/measurement.hpp"
#include "tests/bench/local_methods/scenes.hpp"

namespace sidestep {
namespace {

constexpr double kWholeGrid_s = 100;  // a window that reaches all speeds

struct WindowScene {
  std::vector<Vec2> points_m;
  WheelSpeeds wheels;
  Vec2 goal_m;
};

WindowQuery query_of(const WindowScene& scene, double window_s) {
  return {scene.points_m, scene.wheels, {scene.goal_m, std::nullopt, 0.1}, 0.1, window_s};
}

double value_of(const WindowChoice& choice) {
  return choice.best ? static_cast<double>(choice.admissible[*choice.best].value) : 0;
}

/// Whether every velocity that a table admits is also admissible by exact computation, with a collision time
/// that is not later.
bool is_safe(const std::vector<RatedWheelSpeeds>& exact, const WindowChoice& table) {
  auto next = exact.begin();  // both are in the grid's order
  for (const RatedWheelSpeeds& rated : table.admissible) {
    while (next != exact.end() && (next->wheels.left_mps != rated.wheels.left_mps ||
                                   next->wheels.right_mps != rated.wheels.right_mps))
      ++next;
    if (next == exact.end() || rated.time_to_collision_s > next->time_to_collision_s + 1e-6F) return false;
  }
  return true;
}

}  // namespace

bool compare_windows() {
  const DifferentialDrive drive;
  const ConvexPolygon hull = octagon(0.35);
  DynamicWindowSettings settings;

  constexpr std::size_t kSlowScenes = 60;
  Rng rng(kBenchSeed);
  std::vector<WindowScene> scenes;
  while (scenes.size() < kBenchScenes) {
    std::vector<Vec2> points = laser_scan(rng, kBeams, 0.405);
    const double left = rng.uniform(0, 0.5), right = rng.uniform(0, 0.5), x = rng.uniform(1, 4),
                 y = rng.uniform(-0.3, 0.3) * x;
    scenes.push_back({std::move(points), {left, right}, {x, 0.5 * y}});
  }
  settings.method = CollisionMethod::kExact;
  DynamicWindow exact(drive, hull, settings);
  settings.method = CollisionMethod::kUniformTable;
  DynamicWindow uniform(drive, hull, settings);
  settings.method = CollisionMethod::kLloydMaxTable;
  DynamicWindow fitted(drive, hull, settings);
  print_header("Dynamic window of two wheels, 360 points of a laser; result: value of the best velocity");
  std::vector<Contestant> contestants;
  const auto add = [&](std::string name, DynamicWindow& window, double window_s, std::size_t count) {
    contestants.push_back({std::move(name),
                           count,
                           [&window, &scenes, window_s](std::size_t scene) {
                             return value_of(window.choose(query_of(scenes[scene], window_s)));
                           },
                           {},
                           0});
  };
  add("reachable in 0.1 s, exact arcs", exact, 0.1, kBenchScenes);
  add("reachable in 0.1 s, uniform table", uniform, 0.1, kBenchScenes);
  add("reachable in 0.1 s, Lloyd-Max table", fitted, 0.1, kBenchScenes);
  add("all 41 x 41, exact arcs", exact, kWholeGrid_s, kSlowScenes);
  add("all 41 x 41, uniform table", uniform, kWholeGrid_s, kBenchScenes);
  add("all 41 x 41, Lloyd-Max table", fitted, kWholeGrid_s, kBenchScenes);
  measure(contestants, rng);
  std::size_t unsafe = 0, admitted = 0, admitted_exactly = 0;
  for (std::size_t i = 0; i < kBenchScenes; ++i) {
    const WindowQuery query = query_of(scenes[i], i < kSlowScenes ? kWholeGrid_s : 0.1);
    const std::vector<RatedWheelSpeeds> reference = exact.choose(query).admissible;
    admitted_exactly += reference.size();
    for (DynamicWindow* window : {&uniform, &fitted})
      unsafe += is_safe(reference, window->choose(query)) ? 0 : 1;
    admitted += uniform.choose(query).admissible.size();
  }
  fmt::print("  The uniform table admits {:.1f} % of the velocities that exact computation admits.\n",
             100 * static_cast<double>(admitted) / static_cast<double>(admitted_exactly));
  if (unsafe > 0) fmt::print("WRONG: in {} scenes, a table admits inadmissible velocities\n", unsafe);
  return unsafe == 0;
}

bool compare_disc_windows() {
  constexpr double kRadius_m = 0.09;
  Rng rng(kBenchSeed);
  std::vector<std::vector<Vec2>> scans;
  std::vector<Vec2> velocities;
  while (scans.size() < kBenchScenes) {
    scans.push_back(laser_scan(rng, kBeams, 0.1));
    const double x = rng.uniform(0, 1.2), y = rng.uniform(-1, 1);
    velocities.emplace_back(x, y);
  }
  DiscWindow exact(kRadius_m, {}, {.method = CollisionMethod::kExact}), uniform(kRadius_m, {});
  const auto query = [&](std::size_t scene, double window_s) {
    return DiscWindowQuery{scans[scene], velocities[scene], {3, 0}, 1.0 / 60, window_s};
  };
  print_header(
      "Dynamic window of an omnidirectional disc, 360 points; result: number of admissible velocities");
  std::vector<Contestant> contestants;
  const auto add = [&](std::string name, DiscWindow& window, double window_s) {
    contestants.push_back({std::move(name),
                           kBenchScenes,
                           [&window, query, window_s](std::size_t scene) {
                             return static_cast<double>(
                                 window.choose(query(scene, window_s)).admissible.size());
                           },
                           {},
                           0});
  };
  add("reachable in 1/60 s, exact", exact, 1.0 / 60);
  add("reachable in 1/60 s, uniform table", uniform, 1.0 / 60);
  add("reachable in 0.1 s, exact", exact, 0.1);
  add("reachable in 0.1 s, uniform table", uniform, 0.1);
  add("all 41 x 41, exact", exact, kWholeGrid_s);
  add("all 41 x 41, uniform table", uniform, kWholeGrid_s);
  measure(contestants, rng);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < kBenchScenes; ++i) {
    std::vector<Vec2> allowed;
    for (const RatedVelocity& rated : exact.choose(query(i, 0.1)).admissible)
      allowed.push_back(rated.velocity_mps);
    for (const RatedVelocity& rated : uniform.choose(query(i, 0.1)).admissible)
      wrong += std::ranges::find(allowed, rated.velocity_mps) == allowed.end() ? 1 : 0;
  }
  if (wrong > 0) fmt::print("WRONG: a table admits {} velocities that exact computation rejects\n", wrong);
  return wrong == 0;
}

}  // namespace sidestep
