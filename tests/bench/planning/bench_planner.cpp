// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/planning/bench_planner.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <stdexcept>

#include "agents/planning/named_planner.hpp"
#include "agents/planning/smoothing/leader_follower.hpp"
#include "tests/bench/planning/ompl_planner.hpp"
#include "tests/study/measurement/cpu_clock.hpp"

namespace sidestep {
namespace {

// Half of the maximum, so that planners can add to it without overflow.
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max() / 2;
// Sample limit of anytime planners, which would otherwise always use the whole time limit.
constexpr std::size_t kAnytimeSamples = 2000;

struct Pair {
  const char *namesake, *peer;
};
constexpr Pair kPairs[] = {{"rrt", "ompl-RRT"}, {"rrt-connect", "ompl-RRTConnect"}};

/// One of our planners in a world.
class OwnPlanner {
 public:
  OwnPlanner(const std::string& name, const BenchmarkWorld& world, std::uint64_t seed)
      : world_(world),
        planner_(make_planner(name)),
        domain_settings_(planner_.domain_settings(world.world.field, world.world.radius_m)),
        rng_(seed) {}

  /// Like the peers, limited only by time, except for anytime planners. The measured time includes making the
  /// domain.
  TimedPlan plan(const PlanQuery& query, double max_ms) {
    const std::size_t samples = planner_.kind == PlannerKind::kAnytime ? kAnytimeSamples : kUnlimited;
    const double begin_us = cpu_us();
    const Budget budget{.nodes = kUnlimited,
                        .samples = samples,
                        .until = cpu_time() + from_seconds(1e-3 * max_ms),
                        .clock = cpu_time};
    const DiscDomain domain(world_.obstacles, world_.world.field, world_.world.radius_m, query.start_m,
                            query.goal_m, domain_settings_);
    const Plan<Vec2>& found = planner_.plan(domain, query.start_m, budget, rng_);
    TimedPlan plan;
    plan.plan_us = cpu_us() - begin_us;
    plan.is_solved = found.arrives();
    plan.iterations = found.samples;
    plan.path_m = found.states;
    Plan<Vec2> smoothed = found;
    const double planned_us = cpu_us();
    smoother_.smooth(domain, smoothed);
    plan.smoothing_us = cpu_us() - planned_us;
    plan.smoothed_m = smoothed.states;
    return plan;
  }

 private:
  const BenchmarkWorld& world_;
  NamedPlanner planner_;
  DiscDomainSettings domain_settings_;
  LeaderFollower<DiscDomain> smoother_;
  Rng rng_;
};

/// Returns a function that owns a planner of this type and answers queries with it.
template <typename Planner>
QueryFunction prepared(const std::string& name, const BenchmarkWorld& world, std::uint64_t seed) {
  const auto planner = std::make_shared<Planner>(name, world, seed);
  return [planner](const PlanQuery& query, double max_ms) { return planner->plan(query, max_ms); };
}

template <typename Planner>
BenchPlanner bench_planner(const std::string& name, std::string baseline, bool is_namesake) {
  return {name, std::move(baseline), is_namesake, [name](const BenchmarkWorld& world, std::uint64_t seed) {
            return prepared<Planner>(name, world, seed);
          }};
}

BenchPlanner bench_peer(const std::string& name) { return bench_planner<OmplPlanner>(name, "", false); }

bool is_in(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<BenchPlanner> bench_planners() {
  std::vector<std::string> peers = ompl_planner_names();
  std::vector<BenchPlanner> planners;
  for (const std::string& name : planner_names()) {
    const auto pair = std::find_if(std::begin(kPairs), std::end(kPairs),
                                   [&](const Pair& p) { return p.namesake == name && is_in(peers, p.peer); });
    if (pair == std::end(kPairs)) {
      planners.push_back(bench_planner<OwnPlanner>(name, make_planner(name).baseline, false));
      continue;
    }
    std::erase(peers, pair->peer);
    planners.push_back(bench_peer(pair->peer));
    planners.push_back(bench_planner<OwnPlanner>(name, pair->peer, true));
  }
  for (const std::string& peer : peers) planners.push_back(bench_peer(peer));
  return planners;
}

std::vector<BenchPlanner> select_planners(std::vector<BenchPlanner> all,
                                          const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<std::string> wanted = names;
  for (const BenchPlanner& planner : all)
    if (planner.is_namesake && is_in(names, planner.name)) wanted.push_back(planner.baseline);
  std::erase_if(all, [&](const BenchPlanner& planner) { return !is_in(wanted, planner.name); });
  return all;
}

BenchPlanner planted_planner(const std::string& name) {
  if (name == "invalid-path") {
    return {"planted-invalid-path", "", false, [](const BenchmarkWorld&, std::uint64_t) -> QueryFunction {
              return [](const PlanQuery& query, double) -> TimedPlan {
                const std::vector<Vec2> straight{query.start_m, query.goal_m};
                return {true, 1, 1, 1, straight, straight};
              };
            }};
  }
  if (name == "weak-namesake") {
    return {"planted-weak-namesake", "rrt-connect", true,
            [](const BenchmarkWorld& world, std::uint64_t seed) -> QueryFunction {
              const QueryFunction plan = prepared<OwnPlanner>("rrt-connect", world, seed);
              return [plan, count = 0](const PlanQuery& query, double max_ms) mutable {
                TimedPlan timed = plan(query, max_ms);
                if (++count % 4 == 0) timed.is_solved = false;
                return timed;
              };
            }};
  }
  throw std::invalid_argument(
      fmt::format("planted planner: expected invalid-path or weak-namesake, got \"{}\"", name));
}

}  // namespace sidestep
