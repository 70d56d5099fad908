// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/crowds/reciprocal_avoidance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "common/motion/robot_model.hpp"
#include "deploy/trial/planning/rounded_shape.hpp"

namespace sidestep {
namespace {

void require(bool is_valid, const char* reason) {
  if (!is_valid) throw std::invalid_argument(reason);
}

void check(const ReciprocalSettings& settings) {
  const auto is_positive = [](double value) { return std::isfinite(value) && value > 0; };
  const auto is_sound = [](double value) { return std::isfinite(value) && value >= 0; };
  require(is_positive(settings.time_horizon_s), "the time horizon must be positive");
  require(is_positive(settings.obstacle_horizon_s), "the horizon for obstacles must be positive");
  require(is_sound(settings.neighbour_distance_m), "the distance of neighbours must not be negative");
  require(is_sound(settings.extra_radius_m), "the extra radius must not be negative");
  require(is_sound(settings.noise_mps), "the noise must not be negative");
}

/// A velocity that is distributed uniformly over a disc.
Vec2 random_change(double largest_mps, Rng& rng) {
  const double angle_rad = rng.uniform(0, 2 * std::numbers::pi);
  return rotated(Vec2(largest_mps * std::sqrt(rng.uniform()), 0), angle_rad);
}

/// Shuffles constraints of the linear programme.
void shuffle(std::span<HalfPlane> planes, Rng& rng) { rng.shuffle(planes); }

}  // namespace

ReciprocalAvoidance::ReciprocalAvoidance(const FloorRules& rules, double cycle_s, ReciprocalSettings settings)
    : rules_(rules), cycle_s_(cycle_s), settings_(std::move(settings)) {
  check(settings_);
  require(std::isfinite(cycle_s) && cycle_s > 0, "the cycle must be positive");
  for (const Shape& shape : rules.obstacles) {
    sidestep::check(shape);
    RoundedShape outline = rounded(shape);
    obstacles_.push_back({std::move(outline.corners_m), outline.radius_m, bounds(shape)});
  }
}

void ReciprocalAvoidance::choose(std::span<const ReciprocalRobot> robots, Rng& rng,
                                 std::vector<Vec2>& velocities) {
  by_x_.resize(robots.size());
  std::iota(by_x_.begin(), by_x_.end(), std::size_t{0});
  std::ranges::sort(by_x_, {}, [&](std::size_t robot) { return robots[robot].position_m.x(); });
  place_of_.resize(robots.size());
  for (std::size_t place = 0; place < by_x_.size(); ++place) place_of_[by_x_[place]] = place;
  velocities.resize(robots.size());
  for (std::size_t i = 0; i < robots.size(); ++i) velocities[i] = choose_for(i, robots, rng);
}

Vec2 ReciprocalAvoidance::choose_for(std::size_t index, std::span<const ReciprocalRobot> robots, Rng& rng) {
  const ReciprocalRobot& robot = robots[index];
  planes_.clear();
  if (settings_.chooses_reachable) add_reachable(robot);
  const std::size_t reachable = planes_.size();
  add_edges(robot);
  add_obstacles(robot);
  const std::size_t hard = planes_.size();
  add_neighbours(index, robots);
  shuffle(std::span(planes_).first(reachable), rng);
  shuffle(std::span(planes_).subspan(reachable, hard - reachable), rng);
  shuffle(std::span(planes_).subspan(hard), rng);
  const std::span<const HalfPlane> all(planes_);
  const Circle disc{{0, 0}, robot.max_speed_mps};
  const Vec2 preferred = robot.preferred_mps + random_change(settings_.noise_mps, rng);
  if (const auto free = nearest_inside(all, disc, preferred)) return *free;
  if (const auto best = least_outside(all.first(hard), all.subspan(hard), disc)) return *best;
  // The robot cannot brake in time for the obstacles near it, so they are treated like robots.
  return least_outside(all.first(reachable), all.subspan(reachable), disc).value_or(robot.velocity_mps);
}

void ReciprocalAvoidance::add_reachable(const ReciprocalRobot& robot) {
  constexpr int kSides = 12;
  const MotionLimits& limits = rules_.limits;
  const double ahead_mps2 = limits.acceleration_mps2;
  const double behind_mps2 = is_at_rest(robot.velocity_mps) ? ahead_mps2 : limits.deceleration_mps2;
  const Vec2 forward = forward_of(robot.velocity_mps);
  for (int i = 0; i < kSides; ++i) {
    const Vec2 outwards = rotated(forward, 2 * std::numbers::pi * i / kSides);
    const double along = forward.dot(outwards), across = cross(forward, outwards);
    const double reach_mps2 =
        std::hypot(along * (along >= 0 ? ahead_mps2 : behind_mps2), across * ahead_mps2);
    planes_.push_back({robot.velocity_mps + cycle_s_ * reach_mps2 * outwards, -outwards});
  }
}

void ReciprocalAvoidance::add_edges(const ReciprocalRobot& robot) {
  const Vec2 reach_m = Vec2(rules_.field.length_m, rules_.field.width_m) / 2 -
                       Vec2::Constant(rules_.radius_m + settings_.extra_radius_m);
  for (const int axis : {0, 1})
    for (const double side : {-1.0, 1.0}) {
      const Vec2 outwards = side * (axis == 0 ? Vec2(1, 0) : Vec2(0, 1));
      const double free_m = std::max(0.0, reach_m[axis] - robot.position_m.dot(outwards));
      planes_.push_back({outwards * (free_m / settings_.obstacle_horizon_s), -outwards});
    }
}

void ReciprocalAvoidance::add_obstacles(const ReciprocalRobot& robot) {
  const double own_radius_m = rules_.radius_m + settings_.extra_radius_m;
  const double reach_m = own_radius_m + robot.max_speed_mps * settings_.obstacle_horizon_s;
  for (const Obstacle& obstacle : obstacles_) {
    if (signed_distance(robot.position_m, obstacle.bounds_m) > reach_m) continue;
    corners_m_.clear();
    for (const Vec2& corner : obstacle.corners_m) corners_m_.push_back(corner - robot.position_m);
    const RelativeObstacle relative{corners_m_, own_radius_m + obstacle.radius_m};
    const Vec2 nearest_m = nearest_point_m(relative);
    const double distance_m = nearest_m.norm();
    if (distance_m > relative.separation_m)
      planes_.push_back(
          outside_velocity_obstacle(relative, settings_.obstacle_horizon_s, robot.velocity_mps));
    else if (distance_m > 0)  // It must not come nearer.
      planes_.push_back({{0, 0}, -nearest_m / distance_m});
  }
}

void ReciprocalAvoidance::add_neighbours(std::size_t index, std::span<const ReciprocalRobot> robots) {
  const double near_m = settings_.neighbour_distance_m;
  const auto add_if_near = [&](std::size_t other) {
    const Vec2 offset_m = robots[other].position_m - robots[index].position_m;
    if (std::abs(offset_m.x()) > near_m) return false;
    if (offset_m.squaredNorm() <= near_m * near_m) add_neighbour(robots[index], robots[other]);
    return true;
  };
  for (std::size_t place = place_of_[index]; place > 0;)
    if (!add_if_near(by_x_[--place])) break;
  for (std::size_t place = place_of_[index] + 1; place < by_x_.size(); ++place)
    if (!add_if_near(by_x_[place])) break;
}

void ReciprocalAvoidance::add_neighbour(const ReciprocalRobot& robot, const ReciprocalRobot& other) {
  const std::array<Vec2, 1> offset_m{other.position_m - robot.position_m};
  const Vec2 relative_mps = robot.velocity_mps - other.velocity_mps;
  const double separation_m = 2 * (rules_.radius_m + settings_.extra_radius_m);
  HalfPlane plane;
  if (offset_m[0].norm() > separation_m)
    plane = outside_velocity_obstacle({offset_m, separation_m}, settings_.time_horizon_s, relative_mps);
  else
    plane = separating_velocities(offset_m[0], separation_m, cycle_s_, relative_mps);
  // Each of both robots makes half of the change of their relative velocity.
  planes_.push_back({robot.velocity_mps + (plane.point - relative_mps) / 2, plane.normal});
}

}  // namespace sidestep
