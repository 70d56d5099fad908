// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/contestant.hpp"

#include <fmt/format.h>

#include "deploy/evaluation/planning/cpu_clock.hpp"
#include "deploy/evaluation/planning/replan_course.hpp"

namespace sidestep {

void PlanMeasures::add(const Plan<Vec2>& plan, double us, double shortest_m) {
  plan_us.add(us);
  nodes.add(static_cast<double>(plan.nodes));
  ++asked;
  if (!plan.arrives()) return;
  ++solved;
  if (shortest_m > 0) length.add(plan.length / shortest_m);
}

void PlanMeasures::add(const PlanMeasures& more) {
  asked += more.asked;
  solved += more.solved;
  plan_us.add(more.plan_us);
  nodes.add(more.nodes);
  length.add(more.length);
}

std::vector<std::string> plan_columns(std::vector<std::string> key) {
  for (const char* name : {"queries", "solved_percent", "median_us", "p95_us", "p99_us", "median_nodes",
                           "p95_nodes", "median_length", "p95_length"})
    key.emplace_back(name);
  return key;
}

std::vector<std::string> plan_cells(std::vector<std::string> key, const PlanMeasures& m) {
  key.push_back(fmt::format("{}", m.asked));
  key.push_back(fmt::format("{:.1f}", m.solved_percent()));
  for (const double part : {0.5, 0.95, 0.99}) key.push_back(fmt::format("{:.1f}", m.plan_us.at(part)));
  for (const double part : {0.5, 0.95}) key.push_back(fmt::format("{}", m.nodes.at(part)));
  for (const double part : {0.5, 0.95}) key.push_back(fmt::format("{:.3f}", m.length.at(part)));
  return key;
}

void Contestant::plan(const DiscDomain& domain, const Vec2& start_m, const Budget& budget,
                      double shortest_m) {
  const double begin_us = cpu_us();
  const Plan<Vec2>& plan = ask_(domain, start_m, budget, rng_);
  measures_.add(plan, cpu_us() - begin_us, shortest_m);
}

void ask_all(std::vector<Contestant>& contestants, std::size_t turn, const DiscDomain& domain,
             const Vec2& start_m, const Budget& budget, double shortest_m) {
  for (std::size_t i = 0; i < contestants.size(); ++i)
    contestants[(turn + i) % contestants.size()].plan(domain, start_m, budget, shortest_m);
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
    ask_all(contestants, cycle, domain, course.start_m(), kReplanBudget, shortest_m);
    after_cycle();
  }
}

}  // namespace sidestep
