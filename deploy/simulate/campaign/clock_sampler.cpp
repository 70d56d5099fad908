// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/clock_sampler.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

Duration within(double most_s, Rng& rng) { return from_seconds(rng.uniform(-most_s, most_s)); }

Duration far_beyond(Rng& rng) {
  const double size_s = 0.35 * std::pow(100, rng.uniform());
  return from_seconds(rng.chance(0.5) ? size_s : -size_s);
}

/// An agent's own clock may show anything; vision's only has to be about right.
Duration of_process(const std::string& process, double half_bound_s, Rng& rng) {
  if (process == "vision") return within(0.005, rng);
  if (process.starts_with("coordinator") || process == "simulator") return within(half_bound_s, rng);
  const double u = rng.uniform();
  return within(u < 0.6 ? half_bound_s : u < 0.8 ? 0.02 : 5, rng);
}

}  // namespace

void sample_clocks(Scenario& scenario, FaultPlan& plan, Rng& rng) {
  const bool is_beyond = rng.chance(0.1);
  if (!is_beyond && rng.chance(0.4)) return;
  // Half of the bound for the robot, half for the coordinator.
  const double half_bound_s = 0.499 * scenario.clock_bound_s;
  for (const ProcessNames& host : plan.hosts) {
    for (const std::string& process : host) plan.clocks[process] = of_process(process, half_bound_s, rng);
  }
  // The simulator's host only carries the robots, which have clocks of their own.
  for (RobotSpec& robot : scenario.robots)
    robot.clock_offset = within(half_bound_s, rng) - plan.clocks["simulator"];
  if (!is_beyond) return;

  if (rng.chance(0.2)) {
    const Duration wrong = far_beyond(rng);
    for (auto& [process, offset] : plan.clocks) {
      if (process.starts_with("coordinator")) offset += wrong;
    }
    for (const RobotSpec& robot : scenario.robots) plan.off_clock.push_back(robot.id);
    return;
  }
  for (std::uint64_t left = 1 + rng.below(3); left > 0; --left) {
    RobotSpec& robot = scenario.robots[rng.below(scenario.robots.size())];
    if (std::ranges::find(plan.off_clock, robot.id) != plan.off_clock.end()) continue;
    robot.clock_offset += far_beyond(rng);
    plan.off_clock.push_back(robot.id);
  }
}

}  // namespace sidestep
