// SPDX-License-Identifier: Apache-2.0
#include "deploy/evaluation/planning/named_planner.hpp"

#include <fmt/format.h>
#include <map>
#include <memory>
#include <stdexcept>

#include "agents/planning/anytime.hpp"
#include "agents/planning/grids/grid_planner.hpp"
#include "agents/planning/grids/quad_tree.hpp"
#include "agents/planning/grids/trapezoids.hpp"
#include "agents/planning/roadmaps/prm.hpp"
#include "agents/planning/robust.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"

namespace sidestep {
namespace {

using Trees = BidirectionalErrt<DiscDomain>;

/// Builds its graph when the world is another than the last time.
class FullVisibility {
 public:
  const Plan<Vec2>& plan(const DiscDomain& domain, const Vec2& start, const Budget&, Rng&) {
    if (world_ != &domain.world()) graph_.emplace(domain.world(), domain.field(), domain.radius_m());
    world_ = &domain.world();
    return graph_->plan(start, domain.goal(start));
  }
  const std::optional<TangentGraph>& graph() const { return graph_; }

 private:
  const ObstacleWorld* world_ = nullptr;
  std::optional<TangentGraph> graph_;
};

std::vector<Segment> lines_of(const SearchTree<DiscDomain>& tree) {
  std::vector<Segment> lines;
  for (std::uint32_t node = 1; node < tree.size(); ++node)
    lines.push_back({tree[tree.parent(node)], tree[node]});
  return lines;
}

std::vector<Vec2> points_of(const WaypointCache<Vec2>& cache) {
  std::vector<Vec2> points;
  for (std::size_t i = 0; i < cache.size(); ++i) points.push_back(cache[i]);
  return points;
}

PlanDrawing drawing_of(Errt<DiscDomain>& planner) {
  return {lines_of(planner.tree()), {}, {}, points_of(planner.cache())};
}
PlanDrawing drawing_of(Trees& planner) {
  return {lines_of(planner.start_tree()), lines_of(planner.goal_tree()), {}, points_of(planner.cache())};
}
PlanDrawing drawing_of(Anytime<DiscDomain, Trees>& planner) { return drawing_of(planner.planner()); }
PlanDrawing drawing_of(Prm<DiscDomain>& planner) {
  PlanDrawing drawing;
  const Roadmap<DiscDomain>& map = planner.roadmap();
  for (const auto& edge : map.edges())
    if (edge.is_free) drawing.tree.push_back({map[edge.a], map[edge.b]});
  return drawing;
}
PlanDrawing drawing_of(FullVisibility& planner) {
  return {planner.graph() ? planner.graph()->tangents() : std::vector<Segment>{}, {}, {}, {}};
}
PlanDrawing drawing_of(LazyVisibility& planner) { return {planner.ways(), {}, {}, {}}; }
PlanDrawing drawing_of(GridPlanner& planner) { return {planner.steps(), {}, {}, {}}; }
PlanDrawing drawing_of(QuadTree& planner) { return {{}, {}, planner.cells().cells, {}}; }
PlanDrawing drawing_of(Trapezoids& planner) { return {{}, {}, planner.cells().cells, {}}; }

template <typename Planner, typename... Arguments>
std::function<NamedPlanner()> maker(Arguments... arguments) {
  return [=] {
    const auto planner = std::make_shared<Planner>(arguments...);
    return NamedPlanner{{},
                        PlannerKind::kForAnyWorld,
                        [planner](const DiscDomain& domain, const Vec2& start, const Budget& budget,
                                  Rng& rng) -> const Plan<Vec2>& {
                          return plan_robustly(*planner, domain, start, budget, rng);
                        },
                        [planner] { return drawing_of(*planner); }};
  };
}

struct Maker {
  std::string name;
  std::function<NamedPlanner()> make;
  PlannerKind kind = PlannerKind::kForAnyWorld;
};

const std::vector<Maker>& makers() {
  static const std::vector<Maker> all{
      {"lazy-visibility", maker<LazyVisibility>()},
      {"visibility", maker<FullVisibility>(), PlannerKind::kForOneWorld},
      {"rrt", maker<Errt<DiscDomain>>(ErrtSettings{.cache_capacity = 0})},
      {"errt", maker<Errt<DiscDomain>>()},
      {"rrt-connect", maker<Trees>(BidirectionalErrtSettings{.cache_capacity = 0})},
      {"bi-errt", maker<Trees>()},
      {"bi-errt-4", maker<Trees>(BidirectionalErrtSettings{.bridges = 4})},
      {"anytime", maker<Anytime<DiscDomain, Trees>>(Trees(BidirectionalErrtSettings{.cache_capacity = 0})),
       PlannerKind::kAnytime},
      {"prm", maker<Prm<DiscDomain>>(), PlannerKind::kForOneWorld},
      {"one-shot-prm", maker<Prm<DiscDomain>>(one_shot_prm())},
      {"dynamic-prm", maker<Prm<DiscDomain>>(dynamic_prm())},
      {"grid-bfs", maker<GridPlanner>(GridSettings{.order = GridOrder::kBreadthFirst})},
      {"grid-dfs", maker<GridPlanner>(GridSettings{.order = GridOrder::kDepthFirst})},
      {"grid-a-star", maker<GridPlanner>()},
      {"quad-tree", maker<QuadTree>()},
      {"trapezoids", maker<Trapezoids>()}};
  return all;
}

}  // namespace

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Maker& maker : makers()) all.push_back(maker.name);
    return all;
  }();
  return names;
}

NamedPlanner make_planner(const std::string& name) {
  for (const Maker& maker : makers()) {
    if (maker.name != name) continue;
    NamedPlanner planner = maker.make();
    planner.name = name;
    planner.kind = maker.kind;
    return planner;
  }
  throw std::invalid_argument(
      fmt::format("no planner is called \"{}\": expected one of {}", name, fmt::join(planner_names(), ", ")));
}

}  // namespace sidestep
