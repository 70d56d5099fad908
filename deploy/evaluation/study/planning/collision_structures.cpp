// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/collision_structures.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "common/collision/obstacle_world.hpp"
#include "common/random/rng.hpp"
#include "deploy/evaluation/planning/distribution.hpp"
#include "deploy/evaluation/study/planning/collision_problem.hpp"
#include "deploy/evaluation/study/planning/fcl_tree.hpp"

namespace sidestep {
namespace {

// Marked in the plot: the number of obstacles in the domains of the thesis (Bruce 2006).
constexpr double kMarkedObstacles = 64;

constexpr std::array kCollisionStructures{"linear", "extent masks", "tree of boxes", "FCL tree of boxes"};

/// A structure that holds the obstacles.
struct CollisionContender {
  std::function<double()> query_ns;
  std::function<bool(const Segment&)> touches;
  Distribution ns{};
};

template <typename World>
CollisionContender contender(const CollisionProblem& problem, const std::shared_ptr<World>& world) {
  const auto query = [&world = *world, radius_m = problem.radius_m](const Segment& motion) {
    return world.touches(motion.from_m, motion.to_m, radius_m);
  };
  return {[&problem, world, query] { return query_ns<AnswerUse::kCounted>(problem, query); }, query};
}

/// In the order of their names.
std::vector<CollisionContender> contenders_of(const CollisionProblem& problem) {
  std::vector<CollisionContender> contenders;
  for (const Structure structure : {Structure::kLinear, Structure::kMasks, Structure::kTree})
    contenders.push_back(contender(problem, std::make_shared<ObstacleWorld>(problem.shapes, structure)));
  contenders.push_back(contender(problem, std::make_shared<FclTree>(problem.shapes)));
  return contenders;
}

}  // namespace

StudyTable collision_structures(const CollisionStructures& settings, std::uint64_t seed,
                                const ProgressCallback& progress) {
  StudyTable table;
  table.name = "collision";
  table.columns = {"obstacles", "structure", "queries", "touch_percent", "median_ns", "min_ns", "max_ns"};
  table.plots = {{.title = fmt::format("A swept disc among circles, {} rounds of {} queries", settings.rounds,
                                       settings.queries),
                  .x_label = "obstacles",
                  .y_label = "time of a query [ns]",
                  .has_log_x = true,
                  .has_log_y = true,
                  .marked_x = kMarkedObstacles}};
  for (const char* name : kCollisionStructures) table.plots[0].lines.push_back({name, {}});

  Rng order(seed);
  std::size_t done = 0;
  for (const std::size_t obstacles : settings.obstacles) {
    const CollisionProblem problem(obstacles, settings.queries, true, seed);
    std::vector<CollisionContender> contenders = contenders_of(problem);
    std::vector<std::size_t> sequence(contenders.size());
    std::iota(sequence.begin(), sequence.end(), 0u);
    for (std::size_t round = 0; round < settings.rounds; ++round) {
      order.shuffle(sequence);
      for (const std::size_t i : sequence) contenders[i].ns.add(contenders[i].query_ns());
      progress(++done, settings.obstacles.size() * settings.rounds);
    }
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const CollisionContender& contender = contenders[i];
      const auto touched = std::count_if(problem.motions.begin(), problem.motions.end(), contender.touches);
      const double touch_percent = 100 * static_cast<double>(touched) / static_cast<double>(settings.queries);
      table.rows.push_back(
          cells(obstacles, kCollisionStructures[i], settings.queries, fmt::format("{:.3f}", touch_percent),
                fmt::format("{:.1f}", contender.ns.median()), fmt::format("{:.1f}", contender.ns.quantile(0)),
                fmt::format("{:.1f}", contender.ns.quantile(1))));
      table.plots[0].lines[i].points.push_back({static_cast<double>(obstacles), contender.ns.median(),
                                                contender.ns.quantile(0), contender.ns.quantile(1)});
    }
  }
  return table;
}

}  // namespace sidestep
