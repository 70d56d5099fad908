// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/study/planning/collision_structures.hpp"

#include <array>

#include "common/collision/obstacle_world.hpp"
#include "deploy/evaluation/planning/numbers.hpp"
#include "deploy/evaluation/study/planning/collision_problem.hpp"
#include "deploy/evaluation/study/planning/fcl_tree.hpp"

namespace sidestep {
namespace {

// The thesis's domains have so many.
constexpr double kMarkedObstacles = 64;

constexpr std::array kNames{"linear", "extent masks", "tree of boxes", "FCL tree of boxes"};

/// A structure with the obstacles in it.
struct Side {
  std::function<double()> query_ns;
  std::function<bool(const Segment&)> touches;
  Numbers ns{};
};

template <typename World>
Side side(const CollisionProblem& problem, const std::shared_ptr<World>& world) {
  const auto ask = [&world = *world, radius_m = problem.radius_m](const Segment& way) {
    return world.touches(way.from_m, way.to_m, radius_m);
  };
  return {[&problem, world, ask] { return query_ns<AnswerUse::kCounted>(problem, ask); }, ask};
}

/// In the order of their names.
std::vector<Side> sides_of(const CollisionProblem& problem) {
  std::vector<Side> sides;
  for (const Structure structure : {Structure::kLinear, Structure::kMasks, Structure::kTree})
    sides.push_back(side(problem, std::make_shared<ObstacleWorld>(problem.shapes, structure)));
  sides.push_back(side(problem, std::make_shared<FclTree>(problem.shapes)));
  return sides;
}

}  // namespace

StudyTable collision_structures(const CollisionStructures& settings, std::uint64_t seed,
                                const StudyAdvance& advance) {
  StudyTable table;
  table.name = "collision";
  table.columns = {"obstacles", "structure", "queries", "touch_percent", "median_ns", "least_ns", "most_ns"};
  table.plots = {{.title = fmt::format("A swept disc among circles, {} rounds of {} queries", settings.rounds,
                                       settings.queries),
                  .x_label = "obstacles",
                  .y_label = "time of a query [ns]",
                  .has_log_x = true,
                  .has_log_y = true,
                  .marked_x = kMarkedObstacles}};
  for (const char* name : kNames) table.plots[0].lines.push_back({name, {}});

  std::size_t done = 0;
  for (const std::size_t obstacles : settings.obstacles) {
    const CollisionProblem problem(obstacles, settings.queries, true, seed);
    std::vector<Side> sides = sides_of(problem);
    for (std::size_t round = 0; round < settings.rounds; ++round) {
      for (Side& side : sides) side.ns.add(side.query_ns());
      advance(++done, settings.obstacles.size() * settings.rounds);
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      const auto touched = std::count_if(problem.ways.begin(), problem.ways.end(), side.touches);
      const double touch_percent = 100 * static_cast<double>(touched) / static_cast<double>(settings.queries);
      table.rows.push_back(cells(obstacles, kNames[i], settings.queries, fmt::format("{:.3f}", touch_percent),
                                 fmt::format("{:.1f}", side.ns.median()),
                                 fmt::format("{:.1f}", side.ns.at(0)), fmt::format("{:.1f}", side.ns.at(1))));
      table.plots[0].lines[i].points.push_back(
          {static_cast<double>(obstacles), side.ns.median(), side.ns.at(0), side.ns.at(1)});
    }
  }
  return table;
}

}  // namespace sidestep
