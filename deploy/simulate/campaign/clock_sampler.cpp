// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/clock_sampler.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Duration sample_within(double bound_s, Rng& rng) { return from_seconds(rng.uniform(-bound_s, bound_s)); }

Duration sample_large_offset(Rng& rng) {
  const double size_s = 0.35 * std::pow(100, rng.uniform());
  return from_seconds(rng.chance(0.5) ? size_s : -size_s);
}

/// An agent's own clock may have any offset. Vision's clock needs to be only roughly right.
Duration sample_process_offset(const std::string& process, double half_bound_s, Rng& rng) {
  if (process == "vision") return sample_within(0.005, rng);
  if (process.starts_with("coordinator") || process == "simulator") return sample_within(half_bound_s, rng);
  const double u = rng.uniform();
  return sample_within(u < 0.6 ? half_bound_s : u < 0.8 ? 0.02 : 5, rng);
}

}  // namespace

void sample_clocks(Scenario& scenario, FaultPlan& plan, Rng& rng) {
  const bool is_out_of_bound = rng.chance(0.1);
  if (!is_out_of_bound && rng.chance(0.4)) return;
  // The robot and the coordinator each get half of the bound.
  const double half_bound_s = 0.499 * scenario.clock_bound_s;
  for (const ProcessNames& host : plan.hosts) {
    for (const std::string& process : host)
      plan.clocks[process] = sample_process_offset(process, half_bound_s, rng);
  }
  // The simulator's host only carries the robots, which have their own clocks.
  for (RobotSpec& robot : scenario.robots)
    robot.clock_offset = sample_within(half_bound_s, rng) - plan.clocks["simulator"];
  if (!is_out_of_bound) return;

  if (rng.chance(0.2)) {
    const Duration error = sample_large_offset(rng);
    for (auto& [process, offset] : plan.clocks) {
      if (process.starts_with("coordinator")) offset += error;
    }
    for (const RobotSpec& robot : scenario.robots) plan.robots_out_of_clock_bound.push_back(robot.id);
    return;
  }
  for (std::uint64_t left = 1 + rng.below(3); left > 0; --left) {
    RobotSpec& robot = scenario.robots[rng.below(scenario.robots.size())];
    if (std::ranges::find(plan.robots_out_of_clock_bound, robot.id) != plan.robots_out_of_clock_bound.end())
      continue;
    robot.clock_offset += sample_large_offset(rng);
    plan.robots_out_of_clock_bound.push_back(robot.id);
  }
}

}  // namespace sidestep
