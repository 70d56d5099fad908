// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/give_way_search.hpp"

#include <algorithm>
#include <cmath>

namespace sidestep {
namespace {

/// Distance from other robots' routes beyond the minimum separation.
constexpr double kRouteClearance_m = 0.02;
/// Robots are never exactly where they rest: a gap that is wider than necessary by less than this counts as
/// closed.
constexpr double kSpare_m = 0.005;
/// A search ends when so many places turn out to be out of reach, or so many to have no way back.
constexpr std::size_t kMaxPlans = 12;
constexpr std::size_t kMaxPathSamples = 5000;

/// Whether a robot on this path, which may be a single position, would block a route.
bool is_on_route(const std::vector<Vec2>& route, const std::vector<Vec2>& way, double separation_m) {
  for (std::size_t i = 1; i < route.size(); ++i)
    for (std::size_t k = 0; k < way.size(); ++k)
      if (squared_distance(Segment{way[k], way[std::min(k + 1, way.size() - 1)]},
                           Segment{route[i - 1], route[i]}) < separation_m * separation_m)
        return true;
  return false;
}

bool is_on_line(const std::vector<Vec2>& route, const Vec2& place, double separation_m) {
  for (std::size_t i = 1; i < route.size(); ++i)
    if (squared_distance(place, Segment{route[i - 1], route[i]}) < separation_m * separation_m) return true;
  return false;
}

/// Comparison for heaps with the nearest place on top.
bool is_farther(const std::pair<double, Vec2>& a, const std::pair<double, Vec2>& b) {
  return a.first > b.first;
}

}  // namespace

GiveWaySearch::GiveWaySearch(const GiveWayFloor& floor)
    : floor_(floor), planner_(make_driving_planner("lazy-visibility")) {}

Circle GiveWaySearch::disc_at(const Vec2& position_m) const {
  return {position_m, std::max(0.0, floor_.min_separation_m - floor_.required_m)};
}

void GiveWaySearch::begin(GiveWayQuery query, ObstacleWorld fixed) {
  query_ = std::move(query);
  fixed_ = std::move(fixed);
  routes_.clear();
  way_.clear();
  is_in_the_way_ = is_place_on_route_ = false;
  next_ = 0;
  stage_ = Stage::kRoutes;
}

void GiveWaySearch::step(Rng& rng) {
  switch (stage_) {
    case Stage::kRoutes:
      return plan_route(rng);
    case Stage::kPassages:
      return check_passage(rng);
    case Stage::kPlaces:
      return search_places(rng);
    case Stage::kIdle:
      break;
  }
}

void GiveWaySearch::plan_route(Rng& rng) {
  if (next_ < query_.trips.size()) {
    const auto& [from, to] = query_.trips[next_++];
    if (auto route = path(fixed_, from, to, rng)) routes_.push_back(std::move(*route));
    return;
  }
  if (next_ < query_.trips.size() + query_.returns.size() && !query_.way.empty()) {
    const auto& [from, to] = query_.returns[next_++ - query_.trips.size()];
    const auto route = path(fixed_, from, to, rng);
    is_in_the_way_ |= route && is_on_line(*route, query_.left_m, floor_.min_separation_m);
    return;
  }
  next_ = 0;
  stage_ = query_.way.empty() ? Stage::kPassages : Stage::kIdle;
  is_place_on_route_ = !query_.way.empty() && std::ranges::any_of(routes_, [&](const Way& route) {
    return is_on_line(route, query_.way.back(), floor_.min_separation_m);
  });
  is_in_the_way_ |= !query_.way.empty() && std::ranges::any_of(routes_, [&](const Way& route) {
    return is_on_route(route, query_.way, floor_.min_separation_m) ||
           is_on_line(route, query_.left_m, floor_.min_separation_m);
  });
}

void GiveWaySearch::check_passage(Rng& rng) {
  while (next_ < routes_.size()) {
    const Way& route = routes_[next_++];
    if (!is_on_line(route, query_.position_m, floor_.min_separation_m)) continue;
    // Several robots together may close a path that each of them alone would leave open.
    std::vector<ObstacleId> robots;
    const auto add = [&](const Vec2& position_m) {
      Circle disc = disc_at(position_m);
      disc.radius_m += kSpare_m;
      robots.push_back(fixed_.add(disc));
    };
    add(query_.position_m);
    for (const Vec2& other : query_.others_m)
      if (other != route.front()) add(other);
    const std::optional<Way> around = path(fixed_, route.front(), route.back(), rng);
    for (const ObstacleId robot : robots) fixed_.remove(robot);
    is_in_the_way_ = !around || around->back() != route.back();
    if (is_in_the_way_) begin_places();
    return;
  }
  stage_ = Stage::kIdle;
}

void GiveWaySearch::begin_places() {
  if (query_.home_m) {
    afterwards_ = fixed_;
    for (const Vec2& end : query_.ends_m) afterwards_.add(disc_at(end));
    if (afterwards_.touches(*query_.home_m, floor_.required_m)) query_.home_m.reset();
  }
  // Robots are never exactly at rest.
  for (const Vec2& other : query_.others_m) {
    if (std::ranges::find(query_.passable_m, other) != query_.passable_m.end()) continue;
    Circle disc = disc_at(other);
    disc.radius_m += kRouteClearance_m;
    fixed_.add(disc);
  }
  candidates_.clear();
  taken_.clear();
  unreachable_.clear();
  without_return_.clear();
  found_.clear();
  ring_ = index_ = 0;
  rings_ = static_cast<int>(query_.range_m / (kGridFraction * floor_.radius_m));
  stage_ = Stage::kPlaces;
}

void GiveWaySearch::search_places(Rng& rng) {
  if (!found_.empty()) {
    const auto back = path(afterwards_, found_.back(), *query_.home_m, rng);
    if (back && back->back() == *query_.home_m)
      way_ = found_;
    else
      without_return_.push_back(found_.back());
    found_.clear();
  } else if (const std::optional<Vec2> place = next_place()) {
    auto found = path(fixed_, query_.position_m, *place, rng);
    if (!found || found->back() != *place)
      unreachable_.push_back(*place);
    else
      (query_.home_m ? found_ : way_) = std::move(*found);
  }
  if (!found_.empty()) return;
  const bool are_all_examined = ring_ > rings_ && candidates_.empty();
  if (!way_.empty() || are_all_examined || unreachable_.size() >= kMaxPlans ||
      without_return_.size() >= kMaxPlans)
    stage_ = Stage::kIdle;
}

std::optional<Vec2> GiveWaySearch::next_place() {
  const double spacing_m = kGridFraction * floor_.radius_m;
  for (int examined = 0; examined < kMaxPlaces; ++examined) {
    // All places that are nearer than the ring have been examined.
    if (!candidates_.empty() && (ring_ > rings_ || candidates_.front().first <= ring_ * spacing_m)) {
      std::ranges::pop_heap(candidates_, is_farther);
      const Vec2 place = candidates_.back().second;
      candidates_.pop_back();
      // All places connected with an unreachable place are also unreachable.
      const auto is_connected = [&](const ObstacleWorld& world, const std::vector<Vec2>& others) {
        return std::ranges::any_of(
            others, [&](const Vec2& other) { return !world.touches(other, place, floor_.required_m); });
      };
      if (!is_connected(fixed_, unreachable_) && !is_connected(afterwards_, without_return_)) return place;
      continue;
    }
    const std::optional<Vec2> place = next_of_grid();
    if (!place) return std::nullopt;
    if (!take_candidate(*place)) continue;
    candidates_.emplace_back((*place - query_.position_m).norm(), *place);
    std::ranges::push_heap(candidates_, is_farther);
  }
  return std::nullopt;
}

bool GiveWaySearch::take_candidate(const Vec2& place) {
  // Of several places near each other, one is enough.
  const Vec2 cell = (place - query_.position_m) / (2 * floor_.radius_m);
  const std::pair key{std::lround(cell.x()), std::lround(cell.y())};
  if (taken_.contains(key)) return false;
  const double separation_m = floor_.min_separation_m + kRouteClearance_m;
  const auto is_near = [&](const Vec2& other) { return (other - place).norm() < 2 * floor_.radius_m; };
  if (std::ranges::any_of(query_.unreachable_m, is_near)) return false;
  if (!floor_.field.contains(place, floor_.radius_m) || fixed_.touches(place, floor_.required_m) ||
      std::ranges::any_of(routes_, [&](const Way& route) { return is_on_line(route, place, separation_m); }))
    return false;
  taken_.insert(key);
  return true;
}

std::optional<Vec2> GiveWaySearch::next_of_grid() {
  if (ring_ > rings_) return std::nullopt;
  const int side = 2 * ring_, k = ring_, along = ring_ == 0 ? 0 : index_ % side;
  Vec2 cell(-k + along, -k);
  for (int turns = ring_ == 0 ? 0 : index_ / side; turns > 0; --turns) cell = Vec2(-cell.y(), cell.x());
  if (++index_ >= 4 * side) {
    ++ring_;
    index_ = 0;
  }
  return query_.position_m + kGridFraction * floor_.radius_m * cell;
}

std::optional<std::vector<Vec2>> GiveWaySearch::path(const ObstacleWorld& world, const Vec2& from_m,
                                                     const Vec2& to_m, Rng& rng) const {
  Budget budget;
  budget.samples = kMaxPathSamples;
  const double extra_m = 2 * (floor_.required_m - floor_.radius_m);
  const DiscDomain domain(world, {floor_.field.length_m + extra_m, floor_.field.width_m + extra_m},
                          floor_.required_m, from_m, to_m,
                          planner_.domain_settings(floor_.field, floor_.radius_m));
  const Plan<Vec2>& plan = planner_.plan(domain, from_m, budget, rng);
  if (!plan.arrives()) return std::nullopt;
  return std::vector<Vec2>(plan.states.begin(), plan.states.end());
}

}  // namespace sidestep
