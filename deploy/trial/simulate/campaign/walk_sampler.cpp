// SPDX-License-Identifier: Apache-2.0
#include "deploy/trial/simulate/campaign/walk_sampler.hpp"

namespace sidestep {
namespace {

constexpr int kMaxPlaceAttempts = 1000;

}  // namespace

WalkSampler::WalkSampler(const Scenario& scenario, double radius_m, Rng& rng)
    : field_(scenario.field), radius_m_(radius_m), rng_(&rng), planner_(make_planner("lazy-visibility")) {
  std::vector<Shape> shapes = scenario.obstacles;
  if (scenario.map)
    for (const Box& box : scenario.map->boxes_on(field_)) shapes.emplace_back(box);
  world_ = ObstacleWorld(std::move(shapes));
}

std::optional<Vec2> WalkSampler::sample_free() {
  for (int i = 0; i < kMaxPlaceAttempts; ++i) {
    const double y = rng_->uniform(-0.5, 0.5) * field_.width_m,
                 x = rng_->uniform(-0.5, 0.5) * field_.length_m;
    const Vec2 p(x, y);
    if (is_free(p)) return p;
  }
  return std::nullopt;
}

std::optional<std::vector<Vec2>> WalkSampler::path(const Vec2& from_m, const Vec2& to_m) {
  const DiscDomain domain(world_, field_, radius_m_, from_m, to_m,
                          planner_.domain_settings(field_, radius_m_));
  const Plan<Vec2>& plan = planner_.plan(domain, from_m, {}, *rng_);
  if (!plan.arrives()) return std::nullopt;
  return std::vector<Vec2>(plan.states.begin() + 1, plan.states.end());
}

std::vector<Vec2> WalkSampler::sample_walk(const Vec2& from_m, int places) {
  std::vector<Vec2> walk{from_m};
  for (int i = 0; i < places; ++i) {
    const std::optional<Vec2> place = sample_free();
    if (!place) continue;
    if (const auto part = path(walk.back(), *place)) walk.insert(walk.end(), part->begin(), part->end());
  }
  return walk;
}

}  // namespace sidestep
