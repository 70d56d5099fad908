// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/named_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <memory>
#include <stdexcept>

#include "agents/planning/anytime.hpp"
#include "agents/planning/fallback_goal.hpp"
#include "agents/planning/grids/grid_planner.hpp"
#include "agents/planning/grids/navigation/navigation_planner.hpp"
#include "agents/planning/grids/quad_tree.hpp"
#include "agents/planning/grids/trapezoidal_decomposition.hpp"
#include "agents/planning/roadmaps/prm.hpp"
#include "agents/planning/trees/bidirectional_errt.hpp"
#include "agents/planning/trees/errt.hpp"
#include "agents/planning/visibility/lazy_visibility.hpp"
#include "agents/planning/visibility/tangent_graph.hpp"
#include "common/config/planner_names.hpp"

namespace sidestep {
namespace {

using Trees = BidirectionalErrt<DiscDomain>;

/// Full visibility graph. Rebuilds it if the world differs from the world of the last plan.
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
PlanDrawing drawing_of(LazyVisibility& planner) { return {planner.explored_tangents(), {}, {}, {}}; }
PlanDrawing drawing_of(GridPlanner& planner) { return {planner.steps(), {}, {}, {}}; }
PlanDrawing drawing_of(NavigationPlanner& planner) {
  return {planner.directions(), planner.iso_lines(), {}, {}};
}
PlanDrawing drawing_of(QuadTree& planner) { return {{}, {}, planner.cells().cells, {}}; }
PlanDrawing drawing_of(TrapezoidalDecomposition& planner) { return {{}, {}, planner.cells().cells, {}}; }

/// The settings used by the agents.
DiscDomainSettings agent_domain(const Field&, double) { return {}; }
/// Settings that match OMPL: its range, and uniform samples only.
DiscDomainSettings ompl_domain(const Field& field, double radius) {
  return {.step_m = ompl_range_m(field, radius), .contact_probability = 0};
}
DiscDomainSettings border_sampling_domain(const Field& field, double radius) {
  DiscDomainSettings settings = ompl_domain(field, radius);
  settings.contact_probability = DiscDomainSettings{}.contact_probability;
  return settings;
}

using DomainSettings = DiscDomainSettings (*)(const Field&, double);
using Factory = std::function<NamedPlanner()>;

template <typename Planner, typename... Arguments>
Factory factory(DomainSettings domain_settings, Arguments... arguments) {
  return [=] {
    const auto planner = std::make_shared<Planner>(arguments...);
    NamedPlanner named;
    named.plan = [planner](const DiscDomain& domain, const Vec2& start, const Budget& budget,
                           Rng& rng) -> const Plan<Vec2>& {
      return plan_with_fallback_goal(*planner, domain, start, budget, rng);
    };
    named.draw = [planner] { return drawing_of(*planner); };
    named.domain_settings = domain_settings;
    named.is_shortest = std::is_same_v<Planner, LazyVisibility> || std::is_same_v<Planner, FullVisibility>;
    named.is_random = std::is_same_v<Planner, Errt<DiscDomain>> || std::is_same_v<Planner, Trees> ||
                      std::is_same_v<Planner, Prm<DiscDomain>> ||
                      std::is_same_v<Planner, Anytime<DiscDomain, Trees>>;
    return named;
  };
}

template <typename Planner, typename... Arguments>
Factory shipped(Arguments... arguments) {
  return factory<Planner>(agent_domain, arguments...);
}

/// RRT as in OMPL.
constexpr ErrtSettings kRrt{
    .goal_probability = kOmplGoalBias, .cache_capacity = 0, .tries_straight_line = false};
ErrtSettings rrt_with(void (*change)(ErrtSettings&)) {
  ErrtSettings settings = kRrt;
  change(settings);
  return settings;
}

/// RRTConnect as in OMPL: one extension towards the sample, then as many as possible towards the new node.
constexpr BidirectionalErrtSettings kRrtConnect{
    .cache_capacity = 0, .growth_extensions = 1, .tries_straight_line = false};
BidirectionalErrtSettings rrt_connect_with(void (*change)(BidirectionalErrtSettings&)) {
  BidirectionalErrtSettings settings = kRrtConnect;
  change(settings);
  return settings;
}

/// Leads paths through the middle of passages if these are up to a metre wider than the robot.
constexpr NavigationSettings kKeepsClear{.field = {.clearance_m = 0.5, .contact_cost = 4}};

struct Entry {
  std::string name;
  Factory make;
  std::string baseline{};
  PlannerKind kind = PlannerKind::kForAnyWorld;
};

std::vector<Entry> one_tree_planners() {
  using Tree = Errt<DiscDomain>;
  return {{"rrt", factory<Tree>(ompl_domain, kRrt)},
          {"rrt+straight-line",
           factory<Tree>(ompl_domain, rrt_with([](auto& s) { s.tries_straight_line = true; })), "rrt"},
          {"rrt+border-samples", factory<Tree>(border_sampling_domain, kRrt), "rrt"},
          {"rrt+cache", factory<Tree>(ompl_domain, rrt_with([](auto& s) {
                                        s.cache_capacity = ErrtSettings{}.cache_capacity;
                                      })),
           "rrt"},
          {"errt", shipped<Tree>(), "rrt"}};
}

std::vector<Entry> two_tree_planners() {
  using Settings = BidirectionalErrtSettings;
  const auto two_trees = [](void (*change)(Settings&)) {
    return factory<Trees>(ompl_domain, rrt_connect_with(change));
  };
  return {{"rrt-connect", factory<Trees>(ompl_domain, kRrtConnect)},
          {"rrt-connect+straight-line", two_trees([](Settings& s) { s.tries_straight_line = true; }),
           "rrt-connect"},
          {"rrt-connect+border-samples", factory<Trees>(border_sampling_domain, kRrtConnect), "rrt-connect"},
          {"rrt-connect+cache", two_trees([](Settings& s) { s.cache_capacity = Settings{}.cache_capacity; }),
           "rrt-connect"},
          {"rrt-connect+extend-both",
           two_trees([](Settings& s) { s.growth_extensions = Settings{}.growth_extensions; }), "rrt-connect"},
          {"bi-errt", shipped<Trees>(), "rrt-connect"},
          {"bi-errt-no-cache", shipped<Trees>(Settings{.cache_capacity = 0}), "rrt-connect"},
          {"bi-errt-4-bridges", shipped<Trees>(Settings{.bridges = 4}), "rrt-connect"},
          {"anytime", shipped<Anytime<DiscDomain, Trees>>(Trees(Settings{.cache_capacity = 0})),
           "rrt-connect", PlannerKind::kAnytime}};
}

std::vector<Entry> other_planners() {
  using Roadmaps = Prm<DiscDomain>;
  return {
      {"prm", shipped<Roadmaps>(), "", PlannerKind::kForOneWorld},
      {"one-shot-prm", shipped<Roadmaps>(one_shot_prm()), "prm"},
      {"dynamic-prm", shipped<Roadmaps>(dynamic_prm()), "prm"},
      {"lazy-visibility", shipped<LazyVisibility>(), "visibility"},
      {"visibility", shipped<FullVisibility>(), "", PlannerKind::kForOneWorld},
      {"grid-bfs", shipped<GridPlanner>(GridSettings{.order = GridOrder::kBreadthFirst}), "grid-a-star"},
      {"grid-dfs", shipped<GridPlanner>(GridSettings{.order = GridOrder::kDepthFirst}), "grid-a-star"},
      {"grid-a-star", shipped<GridPlanner>()},
      {"estar", shipped<NavigationPlanner>()},
      {"estar-clearance", shipped<NavigationPlanner>(kKeepsClear), "estar"},
      {"nf1", shipped<NavigationPlanner>(NavigationSettings{.field = {.kernel = GridKernel::kNf1}}), "estar"},
      {"quad-tree", shipped<QuadTree>()},
      {"trapezoids", shipped<TrapezoidalDecomposition>()}};
}

/// Planners that drive robots but plan no paths: local methods that follow another planner's paths.
struct LocalEntry {
  std::string_view name, path_planner;
  LocalMethods methods;
};
constexpr std::array<LocalEntry, 6> kLocalEntries{
    {{"dynamic-window", "lazy-visibility", {.uses_window = true, .ignores_path = true}},
     {"nf1-dynamic-window", "nf1", {.uses_window = true}},
     {"bubble-band", "lazy-visibility", {.uses_band = true}},
     {"nf1-band-dynamic-window", "nf1", {.uses_band = true, .uses_window = true}},
     {"potential-field", "lazy-visibility", {.uses_field = true, .ignores_path = true}},
     {"nf1-potential-field", "nf1", {.uses_field = true}}}};

const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> entries;
    for (const auto& group : {one_tree_planners(), two_tree_planners(), other_planners()})
      entries.insert(entries.end(), group.begin(), group.end());
    return entries;
  }();
  return all;
}

[[noreturn]] void refuse(const std::string& name, const std::vector<std::string>& expected) {
  throw std::invalid_argument(
      fmt::format("planner: expected one of {}, got \"{}\"", fmt::join(expected, ", "), name));
}

}  // namespace

double ompl_range_m(const Field& field, double radius) {
  return 0.2 * std::hypot(field.length_m - 2 * radius, field.width_m - 2 * radius);
}

const std::vector<std::string>& planner_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Entry& entry : entries()) all.push_back(entry.name);
    return all;
  }();
  return names;
}

NamedPlanner make_planner(const std::string& name) {
  const auto entry = std::ranges::find(entries(), name, &Entry::name);
  if (entry == entries().end()) refuse(name, planner_names());
  NamedPlanner planner = entry->make();
  planner.name = name;
  planner.kind = entry->kind;
  planner.baseline = entry->baseline;
  return planner;
}

NamedPlanner make_driving_planner(const std::string& name) {
  if (!std::ranges::count(kDrivingPlanners, name))
    refuse(name, {kDrivingPlanners.begin(), kDrivingPlanners.end()});
  const auto local = std::ranges::find(kLocalEntries, name, &LocalEntry::name);
  if (local == kLocalEntries.end()) {
    NamedPlanner planner = make_planner(name);
    planner.keeps_clear = name == "estar-clearance";
    return planner;
  }
  NamedPlanner planner = make_planner(std::string(local->path_planner));
  planner.name = name;
  planner.local = local->methods;
  return planner;
}

}  // namespace sidestep
