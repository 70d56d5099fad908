// SPDX-License-Identifier: Apache-2.0
#include "deploy/study/planning/contestant.hpp"

#include "deploy/planning/cpu_clock.hpp"
#include "deploy/planning/replan_course.hpp"

namespace sidestep {

void PlanMeasures::add(const PlanMeasures& more) {
  asked += more.asked;
  solved += more.solved;
  plan_us.add(more.plan_us);
  nodes.add(more.nodes);
  length.add(more.length);
}

const Plan<Vec2>& Contestant::plan(const DiscDomain& domain, const Vec2& start_m, const Budget& budget,
                                   double shortest_m) {
  const double begin_us = cpu_us();
  const Plan<Vec2>& plan = ask_(domain, start_m, budget, rng_);
  measures_.plan_us.add(cpu_us() - begin_us);
  measures_.nodes.add(static_cast<double>(plan.nodes));
  ++measures_.asked;
  if (!plan.arrives()) return plan;
  ++measures_.solved;
  if (shortest_m > 0) measures_.length.add(plan.length / shortest_m);
  return plan;
}

void ask_all(std::vector<Contestant>& contestants, const Ground& ground, const DiscDomainSettings& settings) {
  const auto& [world, obstacles, shortest_m] = ground;
  for (std::size_t query = 0; query < world.queries.size(); ++query) {
    const auto& [start_m, goal_m] = world.queries[query];
    const DiscDomain domain(obstacles, world.field, world.radius_m, start_m, goal_m, settings);
    for (std::size_t i = 0; i < contestants.size(); ++i)
      contestants[(query + i) % contestants.size()].plan(domain, start_m, {}, shortest_m[query]);
  }
}

void replan_all(std::vector<Contestant>& contestants, std::size_t cycles, std::uint64_t seed,
                const std::function<void()>& after_cycle) {
  ReplanCourse course(cycles, seed);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
    course.step();
    const DiscDomain domain = course.domain();
    // Places that stand in for a goal that is taken are more or less far.
    const bool is_comparable = course.shortest().arrives() && !domain.goal_is_blocked();
    const double shortest_m = is_comparable ? course.shortest().length : 0;
    for (std::size_t i = 0; i < contestants.size(); ++i)
      contestants[(cycle + i) % contestants.size()].plan(domain, course.start_m(), kReplanBudget, shortest_m);
    after_cycle();
  }
}

}  // namespace sidestep
