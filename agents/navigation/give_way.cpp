// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sidestep {
namespace {

constexpr std::size_t kMaxPathSamples = 5000;

/// Whether a robot that drives along this way, or stays at its only place, would be in the way of a route.
bool is_in_the_way(const std::vector<std::vector<Vec2>>& routes, const std::vector<Vec2>& way,
                   double separation_m) {
  return std::ranges::any_of(routes, [&](const std::vector<Vec2>& route) {
    for (std::size_t i = 1; i < route.size(); ++i)
      for (std::size_t k = 0; k < way.size(); ++k)
        if (squared_distance(Segment{way[k], way[std::min(k + 1, way.size() - 1)]},
                             Segment{route[i - 1], route[i]}) < separation_m * separation_m)
          return true;
    return false;
  });
}

}  // namespace

GiveWay::GiveWay(const Field& field, double radius_m, double required_m, double min_separation_m,
                 const GiveWaySettings& settings)
    : field_(field),
      radius_m_(radius_m),
      required_m_(required_m),
      min_separation_m_(min_separation_m),
      settings_(settings),
      planner_(make_driving_planner("lazy-visibility")),
      range_m_(settings.first_range_m) {}

void GiveWay::restart(Time now) {
  anchored_at_ = now;
  way_.clear();
  yields_to_.clear();
  range_m_ = settings_.first_range_m;
}

bool GiveWay::is_due(Time now, const Vec2& position_m) {
  const bool is_new = now - called_at_ > settings_.max_pause;
  called_at_ = now;
  if (is_new || (position_m - anchor_m_).norm() > settings_.progress_m || now < anchored_at_) {
    anchor_m_ = position_m;
    anchored_at_ = now;
  }
  if (way_.empty() && now - anchored_at_ < settings_.stuck_after) return false;
  return now - checked_at_ >= settings_.retry_after || now < checked_at_;
}

void GiveWay::update(Time now, const Vec2& position_m, std::span<const OtherRobot> others,
                     ObstacleWorld fixed, Rng& rng) {
  checked_at_ = now;
  Scene scene{std::move(fixed), &rng, {}};
  find_routes(scene, others);
  if (!way_.empty()) {
    const bool is_needed = is_in_the_way(scene.routes, way_, min_separation_m_);
    if (!is_needed || now - began_at_ >= settings_.give_up_after) restart(now);
    return;
  }
  if (!blocks_a_passage(scene, position_m)) {
    range_m_ = settings_.first_range_m;
    return;
  }
  way_ = find_way(scene, position_m, others);
  began_at_ = now;
  if (way_.empty()) {
    range_m_ = std::min(2 * range_m_, settings_.longest_range_m);
    return;
  }
  for (const OtherRobot& other : others)
    if (other.has_right_of_way) yields_to_.push_back(other.id);
}

bool GiveWay::blocks_a_passage(Scene& scene, const Vec2& position_m) const {
  const ObstacleId self = scene.fixed.add(disc_at(position_m));
  const bool is_blocked = std::ranges::any_of(scene.routes, [&](const Way& route) {
    if (!is_in_the_way({route}, {position_m}, min_separation_m_)) return false;
    const std::optional<Way> around = path(scene, route.front(), route.back());
    return !around || around->back() != route.back();
  });
  scene.fixed.remove(self);
  return is_blocked;
}

void GiveWay::find_routes(Scene& scene, std::span<const OtherRobot> others) const {
  for (const OtherRobot& other : others) {
    const bool is_passing = std::ranges::find(yields_to_, other.id) != yields_to_.end();
    if (!other.has_right_of_way && !is_passing) continue;
    for (const std::optional<Vec2>& goal : other.goals_m) {
      if (!goal || (*goal - other.position_m).norm() < settings_.progress_m) continue;
      auto route = path(scene, other.position_m, *goal);
      if (!route) continue;
      scene.routes.push_back(std::move(*route));
    }
  }
}

std::vector<Vec2> GiveWay::find_way(Scene& scene, const Vec2& position_m,
                                    std::span<const OtherRobot> others) const {
  const std::vector<Vec2> places = places_near(scene, position_m);
  for (const OtherRobot& other : others) scene.fixed.add(disc_at(other.position_m));
  std::vector<Vec2> unreachable;
  for (const Vec2& place : places) {
    // What is connected with an unreachable place is unreachable too.
    const auto is_connected = [&](const Vec2& other) {
      return !scene.fixed.touches(other, place, required_m_);
    };
    if (std::ranges::any_of(unreachable, is_connected)) continue;
    auto found = path(scene, position_m, place);
    // A place that another robot covers is replaced by a free one.
    if (found && found->back() == place) return std::move(*found);
    unreachable.push_back(place);
    if (unreachable.size() == settings_.max_plans) break;
  }
  return {};
}

std::vector<Vec2> GiveWay::places_near(const Scene& scene, const Vec2& position_m) const {
  const double spacing_m = settings_.grid_fraction * radius_m_;
  const int steps = static_cast<int>(range_m_ / spacing_m);
  std::vector<Vec2> places;
  for (int row = -steps; row <= steps; ++row) {
    for (int column = -steps; column <= steps; ++column) {
      const Vec2 place = position_m + spacing_m * Vec2(column, row);
      if (field_.contains(place, radius_m_) && !scene.fixed.touches(place, required_m_) &&
          !is_in_the_way(scene.routes, {place}, min_separation_m_ + settings_.clearance_m))
        places.push_back(place);
    }
  }
  std::ranges::sort(places, {}, [&](const Vec2& place) { return (place - position_m).squaredNorm(); });
  // One of several that are near each other is enough.
  std::vector<Vec2> apart;
  std::set<std::pair<long, long>> taken;
  for (const Vec2& place : places) {
    const Vec2 cell = (place - position_m) / (2 * radius_m_);
    if (taken.insert({std::lround(cell.x()), std::lround(cell.y())}).second) apart.push_back(place);
  }
  return apart;
}

std::optional<std::vector<Vec2>> GiveWay::path(const Scene& scene, const Vec2& from_m,
                                               const Vec2& to_m) const {
  Budget budget;
  budget.samples = kMaxPathSamples;
  const double extra_m = 2 * (required_m_ - radius_m_);
  const DiscDomain domain(scene.fixed, {field_.length_m + extra_m, field_.width_m + extra_m}, required_m_,
                          from_m, to_m, planner_.domain_settings(field_, radius_m_));
  const Plan<Vec2>& plan = planner_.plan(domain, from_m, budget, *scene.rng);
  if (!plan.arrives()) return std::nullopt;
  return std::vector<Vec2>(plan.states.begin(), plan.states.end());
}

}  // namespace sidestep
