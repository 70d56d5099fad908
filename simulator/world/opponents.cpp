// SPDX-License-Identifier: Apache-2.0
#include "simulator/world/opponents.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace sidestep {
namespace {

constexpr double kSamePoint_m = 0.001;
constexpr int kStepsBetweenSearches = 20;
constexpr double kMaxPush_m =
    0.02;  // assumed maximum displacement of a robot by contacts between two searches

}  // namespace

Opponents::Opponents(std::span<const OpponentSpec> specs, double robot_radius_m, double robot_speed_limit_mps)
    : radius_m_(robot_radius_m), speed_limit_mps_(robot_speed_limit_mps) {
  for (const OpponentSpec& spec : specs) {
    Route route{.waypoints_m = spec.path_m, .speed_mps = spec.speed_mps, .is_loop = false};
    if (route.waypoints_m.size() > 2 &&
        (route.waypoints_m.back() - route.waypoints_m.front()).norm() < kSamePoint_m) {
      route.is_loop = true;
      route.waypoints_m.pop_back();
    }
    discs_.push_back({route.waypoints_m.front(), spec.radius_m});
    routes_.push_back(std::move(route));
  }
}

void Opponents::advance_waypoint(Route& route) {
  const std::size_t last = route.waypoints_m.size() - 1;
  if (route.is_loop) {
    route.next_waypoint = route.next_waypoint == last ? 0 : route.next_waypoint + 1;
    return;
  }
  if (route.next_waypoint == last) route.is_reversed = true;
  if (route.next_waypoint == 0) route.is_reversed = false;
  route.next_waypoint = route.is_reversed ? route.next_waypoint - 1 : route.next_waypoint + 1;
}

void Opponents::follow(Route& route, Vec2& position_m) {
  route.velocity_mps.setZero();
  if (route.waypoints_m.size() == 1) return;
  double left_m = route.speed_mps * kPhysicsStepSeconds;
  // Passes a limited number of waypoints per step, because coincident waypoints take no time to pass.
  for (std::size_t passed = 0; passed <= 2 * route.waypoints_m.size(); ++passed) {
    const Vec2 ahead = route.waypoints_m[route.next_waypoint] - position_m;
    const double distance = ahead.norm();
    if (distance > left_m) {
      position_m += ahead * (left_m / distance);
      route.velocity_mps = ahead * (route.speed_mps / distance);
      return;
    }
    left_m -= distance;
    position_m = route.waypoints_m[route.next_waypoint];
    advance_waypoint(route);
  }
}

void Opponents::step(std::span<const Body> robots) {
  for (std::size_t i = 0; i < routes_.size(); ++i) follow(routes_[i], discs_[i].centre_m);
  if (steps_to_next_search_ == 0) {
    find_near_pairs(robots);
    steps_to_next_search_ = kStepsBetweenSearches;
  }
  --steps_to_next_search_;
  for (Pair& pair : near_pairs_) check_pair(pair, robots[pair.robot]);
}

void Opponents::find_near_pairs(std::span<const Body> robots) {
  touching_pairs_.clear();
  std::copy_if(near_pairs_.begin(), near_pairs_.end(), std::back_inserter(touching_pairs_),
               [](const Pair& pair) { return pair.is_touching; });
  near_pairs_.clear();
  for (std::uint32_t i = 0; i < routes_.size(); ++i) {
    const double travel =
        (speed_limit_mps_ + routes_[i].speed_mps) * kStepsBetweenSearches * kPhysicsStepSeconds;
    const double near_m = discs_[i].radius_m + radius_m_ + kContactHysteresis_m + kMaxPush_m + travel;
    for (std::uint32_t robot = 0; robot < robots.size(); ++robot) {
      if ((robots[robot].position_m() - discs_[i].centre_m).squaredNorm() > near_m * near_m) continue;
      if (!robots[robot].is_on_floor()) continue;
      const bool touches = std::any_of(touching_pairs_.begin(), touching_pairs_.end(), [&](const Pair& pair) {
        return pair.opponent == i && pair.robot == robot;
      });
      near_pairs_.push_back({i, robot, touches});
    }
  }
}

void Opponents::check_pair(Pair& pair, const Body& body) {
  const Circle& disc = discs_[pair.opponent];
  const Vec2 offset = body.position_m() - disc.centre_m;
  const double distance = offset.norm();
  const double clearance = distance - disc.radius_m - radius_m_;
  if (clearance > kContactHysteresis_m) pair.is_touching = false;
  if (clearance >= 0 || pair.is_touching) return;
  pair.is_touching = true;
  const Vec2 normal = distance > 0 ? Vec2(offset / distance) : Vec2(1, 0);
  const double robot_speed = std::max(0.0, -body.velocity_mps().dot(normal));
  const double closing = (routes_[pair.opponent].velocity_mps - body.velocity_mps()).dot(normal);
  ++totals_.crashes;
  if (body.velocity_mps().norm() > kAtRest_mps) {
    auto& recent = totals_.recent_moving_crashes;
    recent[totals_.crashes_while_moving++ % recent.size()] = pair.robot;
  }
  totals_.max_crash_speed_mps = std::max(totals_.max_crash_speed_mps, closing);
  totals_.max_robot_crash_speed_mps = std::max(totals_.max_robot_crash_speed_mps, robot_speed);
}

}  // namespace sidestep
