// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/named_planner.hpp"

#include <algorithm>

#include "common/config/planner_names.hpp"
#include "deploy/trial/planning/plan_picture.hpp"
#include "tests/catch.hpp"

namespace sidestep::named_planner_test {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++times;
  return times;
}

/// A planner and the world that it plans in.
class Planning {
 public:
  Planning(const std::string& planner, const PlanWorld& world)
      : world_(world), obstacles_(world.obstacles), planner_(make_planner(planner)) {}

  Plan<Vec2> plan(const PlanQuery& query) {
    const DiscDomain domain(obstacles_, world_.field, world_.radius_m, query.start_m, query.goal_m,
                            planner_.domain_settings(world_.field, world_.radius_m));
    return planner_.plan(domain, query.start_m, {}, rng_);
  }
  PlanDrawing draw() const { return planner_.draw(); }

 private:
  const PlanWorld& world_;
  ObstacleWorld obstacles_;
  NamedPlanner planner_;
  Rng rng_{1};
};

/// The number of queries that are solved by the straight line alone.
int count_straight(const std::string& planner, const PlanWorld& world) {
  Planning planning(planner, world);
  int straight = 0;
  for (const PlanQuery& query : world.queries) straight += planning.plan(query).states.size() == 2;
  return straight;
}

TEST_CASE("each planner can be created by name, solves queries and draws what it explored") {
  const PlanWorld world = make_world("u", 3, 1);
  const std::string name = GENERATE(from_range(planner_names()));
  CAPTURE(name);
  CHECK(make_planner(name).name == name);
  Planning planning(name, world);
  for (const PlanQuery& query : world.queries) {
    const Plan<Vec2> plan = planning.plan(query);
    REQUIRE(plan.arrives());
    CHECK(is_valid_path(world, plan.states, 1e-9));
    const PlanDrawing drawing = planning.draw();
    CHECK(drawing.tree.size() + drawing.goal_tree.size() + drawing.cells.size() > 2);
    const std::string svg = plan_picture(world, query, drawing, plan.states, plan.states);
    CHECK(count(svg, "<polyline") == 2);
    CHECK(count(svg, "<polygon") == world.obstacles.size() + drawing.cells.size());
    CHECK(count(svg, "<circle") == 2 + drawing.cache.size());
    CHECK(svg.find("nan") == std::string::npos);
    PlanDrawing with_band = drawing;
    with_band.band = {Circle{{0, 0}, 0.5}, Circle{{0.3, 0}, 0.4}, Circle{{0.6, 0}, 0.3}};
    CHECK(count(plan_picture(world, query, with_band, plan.states, plan.states), "<circle") ==
          5 + drawing.cache.size());
  }
}

TEST_CASE("every planner's baseline is also a planner") {
  for (const std::string& name : planner_names()) {
    const std::string baseline = make_planner(name).baseline;
    CAPTURE(name, baseline);
    CHECK((baseline.empty() || std::count(planner_names().begin(), planner_names().end(), baseline) == 1));
  }
}

TEST_CASE("an unknown planner name is refused") {
  CHECK_THROWS_WITH(make_planner("dijkstra"), ContainsSubstring("dijkstra") && ContainsSubstring("bi-errt"));
}

TEST_CASE("planners that keep a graph of one world or use the whole time budget cannot drive robots") {
  for (const std::string_view name : kDrivingPlanners)
    CHECK(make_driving_planner(std::string(name)).kind == PlannerKind::kForAnyWorld);
  CHECK(make_driving_planner("errt").name == "errt");
  CHECK_THROWS_WITH(make_driving_planner("prm"), ContainsSubstring("prm") && ContainsSubstring("errt"));
  CHECK_THROWS_AS(make_driving_planner("anytime"), std::invalid_argument);
  CHECK_THROWS_AS(make_driving_planner("dijkstra"), std::invalid_argument);
}

TEST_CASE(
    "planners named after OMPL planners sample uniformly, remember nothing and do not try the straight "
    "line") {
  const std::string name = GENERATE(as<std::string>(), "rrt", "rrt-connect");
  CAPTURE(name);
  const PlanWorld empty = make_world("empty", 20, 1), u = make_world("u", 5, 1);
  CHECK(make_planner(name).domain_settings(u.field, u.radius_m).contact_probability == 0);
  CHECK(make_planner(name).domain_settings(u.field, u.radius_m).step_m == Approx(0.2 * 9.8 * std::sqrt(2.0)));
  CHECK(count_straight(name, empty) < 10);
  Planning planning(name, u);
  for (const PlanQuery& query : u.queries) planning.plan(query);
  CHECK(planning.draw().cache.empty());
}

TEST_CASE("each variant of rrt and rrt-connect adds exactly one feature") {
  const std::string name = GENERATE(as<std::string>(), "rrt", "rrt-connect");
  CAPTURE(name);
  const PlanWorld empty = make_world("empty", 20, 1), u = make_world("u", 5, 1);
  CHECK(count_straight(name + "+straight-line", empty) == 20);
  CHECK(count_straight(name + "+border-samples", empty) < 10);
  CHECK(count_straight(name + "+cache", empty) < 10);
  CHECK(make_planner(name + "+border-samples").domain_settings(u.field, u.radius_m).contact_probability > 0);
  CHECK(make_planner(name + "+cache").domain_settings(u.field, u.radius_m).contact_probability == 0);
  CHECK(make_planner(name + "+straight-line").domain_settings(u.field, u.radius_m).contact_probability == 0);
  Planning cached(name + "+cache", u), straight(name + "+straight-line", u);
  for (const PlanQuery& query : u.queries) {
    cached.plan(query);
    straight.plan(query);
  }
  CHECK_FALSE(cached.draw().cache.empty());
  CHECK(straight.draw().cache.empty());
}

}  // namespace sidestep::named_planner_test
