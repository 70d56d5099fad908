// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace sidestep {
namespace {

constexpr int kStepsBetweenSearches = 20;
constexpr double kMaxPush_m = 0.02;  // assumed maximum approach of a pair by contacts between two searches

}  // namespace

Contacts::Contacts(std::span<const Shape> obstacles, std::shared_ptr<const FloorMap> map,
                   double robot_radius_m, double speed_limit_mps)
    : obstacles_(obstacles.begin(), obstacles.end()),
      map_(std::move(map)),
      radius_m_(robot_radius_m),
      speed_limit_mps_(speed_limit_mps) {}

void Contacts::step(std::span<Body> bodies) {
  if (steps_to_next_search_ == 0) {
    save_touching_pairs();
    find_near_pairs(bodies);
    steps_to_next_search_ = kStepsBetweenSearches;
  }
  --steps_to_next_search_;
  overlaps_.clear();
  for (Pair& pair : near_pairs_) check_pair(pair, bodies);
  for (const Overlap& overlap : overlaps_) separate(overlap, bodies);
}

void Contacts::save_touching_pairs() {
  touching_pairs_.clear();
  std::copy_if(near_pairs_.begin(), near_pairs_.end(), std::back_inserter(touching_pairs_),
               [](const Pair& pair) { return pair.is_touching; });
}

void Contacts::find_near_pairs(std::span<const Body> bodies) {
  const double travel = speed_limit_mps_ * kStepsBetweenSearches * kPhysicsStepSeconds;
  const double near_m = std::max(totals_.min_clearance_m, 0.0) + 2 * travel + kMaxPush_m;
  const auto count = static_cast<std::uint32_t>(bodies.size());
  near_pairs_.clear();
  const auto add = [this](std::uint32_t first, std::uint32_t second) {
    const bool touching = std::any_of(touching_pairs_.begin(), touching_pairs_.end(), [&](const Pair& pair) {
      return pair.first == first && pair.second == second;
    });
    near_pairs_.push_back({first, second, touching});
  };

  if (by_x_.size() != count) {
    by_x_.resize(count);
    std::iota(by_x_.begin(), by_x_.end(), 0U);
  }
  std::sort(by_x_.begin(), by_x_.end(), [&bodies](std::uint32_t a, std::uint32_t b) {
    const double ax = bodies[a].position_m().x(), bx = bodies[b].position_m().x();
    return ax != bx ? ax < bx : a < b;
  });
  const double max_distance_m = 2 * radius_m_ + near_m;
  for (std::size_t i = 0; i < count; ++i) {
    if (!bodies[by_x_[i]].is_on_floor()) continue;
    const Vec2& here = bodies[by_x_[i]].position_m();
    for (std::size_t j = i + 1; j < count; ++j) {
      const Vec2 offset = bodies[by_x_[j]].position_m() - here;
      if (offset.x() > max_distance_m) break;
      if (offset.squaredNorm() <= max_distance_m * max_distance_m && bodies[by_x_[j]].is_on_floor()) {
        add(std::min(by_x_[i], by_x_[j]), std::max(by_x_[i], by_x_[j]));
      }
    }
  }
  for (std::uint32_t robot = 0; robot < count; ++robot) {
    if (!bodies[robot].is_on_floor()) continue;
    const auto last = static_cast<std::uint32_t>(obstacles_.size());
    for (std::uint32_t k = 0; k < last + (map_ ? 1 : 0); ++k)
      if (facing(bodies[robot].position_m(), k, radius_m_ + near_m)) add(robot, count + k);
  }
}

std::optional<Circle> Contacts::facing(const Vec2& position_m, std::size_t obstacle, double near_m) const {
  if (obstacle == obstacles_.size()) return map_->disc_facing(position_m, near_m);
  if (signed_distance(position_m, obstacles_[obstacle]) > near_m) return std::nullopt;
  return disc_facing(position_m, obstacles_[obstacle]);
}

void Contacts::check_pair(Pair& pair, std::span<const Body> bodies) {
  const Vec2& position_m = bodies[pair.first].position_m();
  const double farthest_m = radius_m_ + std::max(totals_.min_clearance_m, kContactHysteresis_m);
  const std::optional<Circle> other = pair.second < bodies.size()
                                          ? Circle{bodies[pair.second].position_m(), radius_m_}
                                          : facing(position_m, pair.second - bodies.size(), farthest_m);
  if (!other) {
    pair.is_touching = false;
    return;
  }
  const Vec2 offset = position_m - other->centre_m;
  const double radii = radius_m_ + other->radius_m;
  const double max_distance_m = radii + std::max(totals_.min_clearance_m, 0.0);
  const double square = offset.squaredNorm();
  if (square >= max_distance_m * max_distance_m && !pair.is_touching) return;

  const double distance = std::sqrt(square);
  const double clearance = distance - radii;
  totals_.min_clearance_m = std::min(totals_.min_clearance_m, clearance);
  if (clearance >= 0) {
    if (clearance > kContactHysteresis_m) pair.is_touching = false;
    return;
  }
  if (!pair.is_touching)
    totals_.recent_contacts[totals_.contacts++ % totals_.recent_contacts.size()] = {pair.first, pair.second};
  pair.is_touching = true;
  totals_.penetration_m_s += -clearance * kPhysicsStepSeconds;
  const Vec2 normal = distance > 0 ? Vec2(offset / distance) : Vec2(1, 0);
  overlaps_.push_back({pair.first, pair.second, normal, -clearance});
}

void Contacts::separate(const Overlap& overlap, std::span<Body> bodies) {
  Body& robot = bodies[overlap.first];
  Body* other = overlap.second < bodies.size() ? &bodies[overlap.second] : nullptr;
  const Vec2 relative = robot.velocity_mps() - (other ? other->velocity_mps() : Vec2(0, 0));
  const double share = other ? 0.5 : 1.0;
  const Vec2 shift = overlap.normal * (share * overlap.depth_m);
  const Vec2 change = overlap.normal * (share * std::max(0.0, -relative.dot(overlap.normal)));
  robot.displace(shift, change);
  if (other) other->displace(-shift, -change);
}

}  // namespace sidestep
