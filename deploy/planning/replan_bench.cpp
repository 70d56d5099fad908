// SPDX-License-Identifier: Apache-2.0
#include "deploy/planning/replan_bench.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "agents/planning/robust.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "deploy/planning/cpu_clock.hpp"
#include "deploy/planning/named_planner.hpp"
#include "deploy/planning/ompl_planner.hpp"
#include "deploy/planning/worlds.hpp"

namespace sidestep {
namespace {

constexpr int kCycles = 2670;
constexpr double kCycle_s = 1.0 / 60, kSpeed_mps = 2, kObstacleSpeed_mps = 0.5;

/// Circles that go straight, and come back from the field's borders.
class MovingCircles {
 public:
  MovingCircles(const PlanWorld& world, Rng& rng) : field_(world.field), obstacles_(world.obstacles) {
    for (std::size_t i = 0; i < world.obstacles.size(); ++i)
      velocities_mps_.push_back(rotated({kObstacleSpeed_mps, 0}, rng.uniform(0, 6.283185307179586)));
  }

  void step() {
    for (std::uint32_t i = 0; i < velocities_mps_.size(); ++i) {
      const Vec2 at = std::get<Circle>(obstacles_.shape(ObstacleId{i})).centre_m;
      Vec2& velocity = velocities_mps_[i];
      if (at.x() * velocity.x() > 0 && std::abs(at.x()) > field_.length_m / 2) velocity.x() *= -1;
      if (at.y() * velocity.y() > 0 && std::abs(at.y()) > field_.width_m / 2) velocity.y() *= -1;
      obstacles_.move(ObstacleId{i}, kCycle_s * velocity);
    }
  }
  const ObstacleWorld& obstacles() const { return obstacles_; }

 private:
  Field field_;
  ObstacleWorld obstacles_;
  std::vector<Vec2> velocities_mps_;
};

/// Where one is after so much of a way.
Vec2 place_on(const std::vector<Vec2>& way, double length_m) {
  for (std::size_t i = 1; i < way.size(); ++i) {
    const double leg_m = (way[i] - way[i - 1]).norm();
    if (leg_m >= length_m && leg_m > 0) return way[i - 1] + length_m / leg_m * (way[i] - way[i - 1]);
    length_m -= leg_m;
  }
  return way.back();
}

struct Cycle {
  double plan_us = 0;
  bool solved = false, valid = false;
};

/// By distances, as is_valid_way does, but for a way that begins in an obstacle.
bool is_valid(const MovingCircles& circles, const PlanWorld& world, const std::vector<Vec2>& way) {
  PlanWorld now = world;
  for (std::uint32_t i = 0; i < now.obstacles.size(); ++i)
    now.obstacles[i] = circles.obstacles().shape(ObstacleId{i});
  return !is_free(now, way.front()) || is_valid_way(now, way, 0.02, 1e-9);
}

/// Drives the shortest way, whatever planner is measured, so that all are asked the same.
std::vector<Cycle> drive(NamedPlanner& planner, const PlanBenchOptions& options) {
  Rng rng(options.seed), planner_rng(options.seed);
  const PlanWorld world = make_world("circles", kCycles, options.seed);
  MovingCircles circles(world, rng);
  LazyVisibility driver;
  std::vector<Cycle> cycles;
  Vec2 at = world.queries[0].start_m;
  std::size_t goal = 0;
  for (int i = 0; i < kCycles; ++i) {
    circles.step();
    if ((world.queries[goal].goal_m - at).norm() < 0.1) ++goal;
    const DiscDomain domain(circles.obstacles(), world.field, world.radius_m, at, world.queries[goal].goal_m);
    const double begin_us = cpu_us();
    const Plan<Vec2>& plan = planner.plan(domain, at, {.nodes = 2000, .samples = 20'000}, planner_rng);
    const double plan_us = cpu_us() - begin_us;
    cycles.push_back({plan_us, plan.arrives(), is_valid(circles, world, plan.states)});
    const Plan<Vec2>& way = plan_robustly(driver, domain, at, {}, rng);
    at = place_on(way.states, kSpeed_mps * kCycle_s);
    if (!way.arrives()) goal = (goal + 1) % world.queries.size();
  }
  return cycles;
}

}  // namespace

void bench_replanning(const PlanBenchOptions& options) {
  fmt::print("\n{} plans at 60 Hz among 64 circles that move at {} m/s, microseconds of one core.\n\n",
             kCycles, kObstacleSpeed_mps);
  fmt::print("| planner          | solved  | median    | p95       | p99       | mean      | invalid |\n");
  fmt::print("|------------------|--------:|----------:|----------:|----------:|----------:|--------:|\n");
  for (const std::string& name : options.planners.empty() ? planner_names() : options.planners) {
    if (is_ompl_planner(name)) continue;
    NamedPlanner planner = make_planner(name);
    if (planner.kind != PlannerKind::kForAnyWorld) continue;
    std::vector<Cycle> cycles = drive(planner, options);
    const auto solved = std::count_if(cycles.begin(), cycles.end(), [](const Cycle& c) { return c.solved; });
    std::sort(cycles.begin(), cycles.end(),
              [](const Cycle& a, const Cycle& b) { return a.plan_us < b.plan_us; });
    const auto invalid = std::count_if(cycles.begin(), cycles.end(), [](const Cycle& c) { return !c.valid; });
    double sum_us = 0;
    for (const Cycle& cycle : cycles) sum_us += cycle.plan_us;
    const auto at = [&](double part) { return cycles[static_cast<std::size_t>(part * kCycles)].plan_us; };
    fmt::print("| {:<16} | {:>5.1f} % | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>9.1f} | {:>7} |\n", name,
               100.0 * static_cast<double>(solved) / kCycles, at(0.5), at(0.95), at(0.99), sum_us / kCycles,
               invalid);
    std::fflush(stdout);
  }
}

}  // namespace sidestep
