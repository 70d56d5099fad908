// SPDX-License-Identifier: Apache-2.0
#include "deploy/simulate/campaign/way_finder.hpp"

#include <utility>

namespace sidestep {

WayFinder::WayFinder(const Scenario& scenario, double radius_m, Rng& rng)
    : field_(scenario.field), radius_m_(radius_m), rng_(&rng), planner_(make_planner("lazy-visibility")) {
  std::vector<Shape> shapes = scenario.obstacles;
  if (scenario.map)
    for (const Box& box : scenario.map->boxes_on(field_)) shapes.emplace_back(box);
  world_ = ObstacleWorld(std::move(shapes));
}

Vec2 WayFinder::sample_free() {
  while (true) {
    const double y = rng_->uniform(-0.5, 0.5) * field_.width_m,
                 x = rng_->uniform(-0.5, 0.5) * field_.length_m;
    if (is_free({x, y})) return {x, y};
  }
}

std::optional<std::vector<Vec2>> WayFinder::path(const Vec2& from_m, const Vec2& to_m) {
  const DiscDomain domain(world_, field_, radius_m_, from_m, to_m,
                          planner_.domain_settings(field_, radius_m_));
  const Plan<Vec2>& plan = planner_.plan(domain, from_m, {}, *rng_);
  if (!plan.arrives() || plan.goal_blocked) return std::nullopt;
  return std::vector<Vec2>(plan.states.begin() + 1, plan.states.end());
}

}  // namespace sidestep
