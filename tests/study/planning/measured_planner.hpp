// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "agents/planning/fallback_goal.hpp"
#include "deploy/trial/planning/worlds.hpp"
#include "tests/study/measurement/distribution.hpp"

namespace sidestep {

/// Statistics of a planner's plans.
struct PlanStatistics {
  std::size_t queries = 0, solved = 0;
  Distribution plan_us{}, nodes{};
  Distribution length{};  ///< path length relative to the shortest path; over solved queries

  /// `shortest_m` is the length of the shortest path; 0 if unknown.
  void add(const Plan<Vec2>& plan, double us, double shortest_m);
  void add(const PlanStatistics& other);
  double solved_percent() const { return 100.0 * static_cast<double>(solved) / static_cast<double>(queries); }
};

/// The columns of a table of plan statistics: the key's columns, then the measurements.
std::vector<std::string> plan_columns(std::vector<std::string> key);
/// A row of the table with plan_columns(). The 99th percentile is empty for fewer than kMinForP99 plans.
std::vector<std::string> plan_cells(std::vector<std::string> key, const PlanStatistics& statistics);

/// Creates a query's domain with a planner's settings.
using DomainFactory = std::function<DiscDomain(const DiscDomainSettings&)>;
DomainFactory domain_factory(const ObstacleWorld& obstacles, const PlanWorld& world, const PlanQuery& query);

/// A planner under comparison, and the statistics of its plans.
class MeasuredPlanner {
 public:
  using PlanFunction =
      std::function<const Plan<Vec2>&(const DiscDomain&, const Vec2& start_m, const Budget&, Rng&)>;

  MeasuredPlanner(std::string name, PlanFunction plan, std::uint64_t seed,
                  const DiscDomainSettings& domain_settings = {})
      : name_(std::move(name)), plan_(std::move(plan)), rng_(seed), domain_settings_(domain_settings) {}

  void plan(const DomainFactory& domain, const Vec2& start_m, const Budget& budget, double shortest_m);

  const std::string& name() const { return name_; }
  const PlanStatistics& statistics() const { return statistics_; }

 private:
  std::string name_;
  PlanFunction plan_;
  Rng rng_;
  DiscDomainSettings domain_settings_;
  PlanStatistics statistics_;
};

/// Returns a function that owns a planner and plans with it.
template <typename Planner>
MeasuredPlanner::PlanFunction plan_function(std::shared_ptr<Planner> planner) {
  return [planner = std::move(planner)](const DiscDomain& domain, const Vec2& start_m, const Budget& budget,
                                        Rng& rng) -> const Plan<Vec2>& {
    return plan_with_fallback_goal(*planner, domain, start_m, budget, rng);
  };
}

/// Creates a measured planner of this type with these settings.
template <typename Planner, typename... Settings>
MeasuredPlanner measured_planner(std::string name, std::uint64_t seed, const Settings&... settings) {
  return {std::move(name), plan_function(std::make_shared<Planner>(settings...)), seed};
}

/// Gives all planners the same query, in an order shuffled by `order`, because a planner's time depends on
/// the contents of the processor's caches.
void plan_all(std::vector<MeasuredPlanner>& planners, Rng& order, const DomainFactory& domain,
              const Vec2& start_m, const Budget& budget, double shortest_m);

/// Gives all planners the queries of a ReplanCourse.
void replan_all(std::vector<MeasuredPlanner>& planners, std::size_t cycles, std::uint64_t seed,
                const std::function<void()>& after_cycle);

}  // namespace sidestep
