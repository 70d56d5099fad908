// SPDX-License-Identifier: Apache-2.0
#include "tests/study/planning/measured_planner.hpp"

#include <fmt/format.h>
#include <numeric>

#include "tests/study/measurement/cpu_clock.hpp"
#include "tests/study/problems/replan_course.hpp"

namespace sidestep {

void PlanStatistics::add(const Plan<Vec2>& plan, double us, double shortest_m) {
  plan_us.add(us);
  nodes.add(static_cast<double>(plan.nodes));
  ++queries;
  if (!plan.arrives()) return;
  ++solved;
  if (shortest_m > 0) length.add(plan.length / shortest_m);
}

void PlanStatistics::add(const PlanStatistics& other) {
  queries += other.queries;
  solved += other.solved;
  plan_us.add(other.plan_us);
  nodes.add(other.nodes);
  length.add(other.length);
}

std::vector<std::string> plan_columns(std::vector<std::string> key) {
  for (const char* name : {"queries", "solved_percent", "median_us", "p95_us", "p99_us", "median_nodes",
                           "p95_nodes", "median_length", "p95_length"})
    key.emplace_back(name);
  return key;
}

std::vector<std::string> plan_cells(std::vector<std::string> key, const PlanStatistics& s) {
  key.push_back(fmt::format("{}", s.queries));
  key.push_back(fmt::format("{:.1f}", s.solved_percent()));
  for (const double part : {0.5, 0.95}) key.push_back(fmt::format("{:.1f}", s.plan_us.quantile(part)));
  key.push_back(s.queries >= kMinForP99 ? fmt::format("{:.1f}", s.plan_us.quantile(0.99)) : "");
  for (const double part : {0.5, 0.95}) key.push_back(fmt::format("{}", s.nodes.quantile(part)));
  for (const double part : {0.5, 0.95}) key.push_back(fmt::format("{:.3f}", s.length.quantile(part)));
  return key;
}

DomainFactory domain_factory(const ObstacleWorld& obstacles, const PlanWorld& world, const PlanQuery& query) {
  return [&](const DiscDomainSettings& settings) {
    return DiscDomain(obstacles, world.field, world.radius_m, query.start_m, query.goal_m, settings);
  };
}

void MeasuredPlanner::plan(const DomainFactory& domain_factory, const Vec2& start_m, const Budget& budget,
                           double shortest_m) {
  const DiscDomain domain = domain_factory(domain_settings_);
  const double begin_us = cpu_us();
  const Plan<Vec2>& plan = plan_(domain, start_m, budget, rng_);
  statistics_.add(plan, cpu_us() - begin_us, shortest_m);
}

void plan_all(std::vector<MeasuredPlanner>& planners, Rng& order, const DomainFactory& domain,
              const Vec2& start_m, const Budget& budget, double shortest_m) {
  std::vector<std::size_t> sequence(planners.size());
  std::iota(sequence.begin(), sequence.end(), 0u);
  order.shuffle(sequence);
  for (const std::size_t i : sequence) planners[i].plan(domain, start_m, budget, shortest_m);
}

void replan_all(std::vector<MeasuredPlanner>& planners, std::size_t cycles, std::uint64_t seed,
                const std::function<void()>& after_cycle) {
  ReplanCourse course(cycles, seed);
  Rng order(seed);
  for (std::size_t cycle = 0; cycle < cycles; ++cycle) {
    course.step();
    // If the goal is blocked, planners may reach different fallback goals, so lengths are not comparable.
    const bool is_comparable = course.shortest().arrives() && !course.domain().goal_is_blocked();
    const double shortest_m = is_comparable ? course.shortest().length : 0;
    const auto domain = [&](const DiscDomainSettings& settings) { return course.domain(settings); };
    plan_all(planners, order, domain, course.start_m(), kReplanBudget, shortest_m);
    after_cycle();
  }
}

}  // namespace sidestep
