// SPDX-License-Identifier: Apache-2.0
#include "agents/planning/joint/fastest_stop.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/motion/rest.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

constexpr int kTurnDirections = 24;
constexpr double kMaxTurn_s = 1.5, kSpeedTolerance_mps = 1e-7, kOnGoal_m = 1e-9;

/// The durations of the straight part of the motion.
struct StraightTimes {
  double accelerate_s = 0, cruise_s = 0, brake_s = 0, peak_mps = 0;
  double total_s() const { return accelerate_s + cruise_s + brake_s; }
};

/// The fastest straight motion to rest over a distance; nullopt if the robot cannot stop within it.
std::optional<StraightTimes> straight_times(double speed_mps, double distance_m, const MotionLimits& limits) {
  const double accelerate = limits.acceleration_mps2, brake = limits.deceleration_mps2;
  if (speed_mps * speed_mps / (2 * brake) > distance_m + kOnGoal_m) return std::nullopt;
  StraightTimes times;
  const double squared_peak =
      (2 * distance_m + speed_mps * speed_mps / accelerate) / (1 / accelerate + 1 / brake);
  times.peak_mps = std::clamp(std::sqrt(squared_peak), speed_mps, std::max(speed_mps, limits.speed_mps));
  if (times.peak_mps <= 0) return times;
  times.accelerate_s = (times.peak_mps - speed_mps) / accelerate;
  times.brake_s = times.peak_mps / brake;
  const double ramps_m =
      (speed_mps + times.peak_mps) / 2 * times.accelerate_s + times.peak_mps / 2 * times.brake_s;
  times.cruise_s = std::max(0.0, distance_m - ramps_m) / times.peak_mps;
  return times;
}

/// The time after which a robot with this acceleration moves on a line through the goal; nullopt if that
/// never happens. The velocity and the way to the goal are parallel if their cross product is zero, which is
/// quadratic in time.
std::optional<double> turn_s(const State& from, const Vec2& acceleration, const Vec2& goal_m) {
  const Vec2 way = goal_m - from.position_m;
  const double a = cross(from.velocity_mps, acceleration) / 2, b = cross(acceleration, way),
               c = cross(from.velocity_mps, way);
  std::array<double, 2> roots{-1, -1};
  if (std::abs(a) < 1e-12) {
    if (b != 0) roots[0] = -c / b;
  } else {
    const double discriminant = b * b - 4 * a * c;
    if (discriminant < 0) return std::nullopt;
    const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    roots = {q / a, q != 0 ? c / q : -1};
  }
  double best_s = kMaxTurn_s;
  bool is_found = false;
  for (const double root : roots) {
    if (!(root >= 0 && root < best_s)) continue;
    const State after = state_after(from, acceleration, root);
    if (after.velocity_mps.dot(goal_m - after.position_m) < 0) continue;
    best_s = root;
    is_found = true;
  }
  return is_found ? std::optional(best_s) : std::nullopt;
}

struct Turn {
  Vec2 acceleration_mps2{0, 0};
  double seconds = 0;
};

/// The turn in which the robot accelerates in a direction as strongly as it may, until it moves towards the
/// goal. The permitted acceleration depends on its duration, so both are found by iteration.
std::optional<Turn> turn_towards(const State& from, const Vec2& direction, const Vec2& goal_m,
                                 const MotionLimits& limits) {
  constexpr int kIterations = 3;
  const Vec2 requested = std::max(limits.acceleration_mps2, limits.deceleration_mps2) * direction;
  Turn turn{{0, 0}, 0.1};
  for (int i = 0; i < kIterations; ++i) {
    turn.acceleration_mps2 =
        limit_acceleration(requested, from.velocity_mps, limits, from_seconds(turn.seconds));
    const std::optional<double> seconds = turn_s(from, turn.acceleration_mps2, goal_m);
    if (!seconds) return std::nullopt;
    turn.seconds = *seconds;
  }
  const Vec2 after = from.velocity_mps + turn.seconds * turn.acceleration_mps2;
  const bool is_valid =
      after.norm() <= limits.speed_mps + kSpeedTolerance_mps &&
      stays_admissible(turn.acceleration_mps2, from.velocity_mps, limits, from_seconds(turn.seconds));
  return is_valid ? std::optional(turn) : std::nullopt;
}

Trajectory motion_along(Time start, const State& from, const Turn& turn, const StraightTimes& times,
                        const Vec2& goal_m, const MotionLimits& limits) {
  Trajectory motion(start, from);
  const auto append = [&](double seconds, const Vec2& acceleration) {
    if (const Duration duration = from_seconds(seconds); duration > Duration{0})
      motion.append(duration, acceleration);
  };
  append(turn.seconds, turn.acceleration_mps2);
  const State turned = state_after(from, turn.acceleration_mps2, turn.seconds);
  const Vec2 way = goal_m - turned.position_m;
  const Vec2 direction = way.norm() > kOnGoal_m ? Vec2(way.normalized()) : forward_of(turned.velocity_mps);
  append(times.accelerate_s, limits.acceleration_mps2 * direction);
  append(times.cruise_s, Vec2::Zero());
  append(times.brake_s, -limits.deceleration_mps2 * direction);
  return motion;
}

}  // namespace

double longest_stop_s(const State& from, const Vec2& goal_m, const MotionLimits& limits) {
  const double speed = from.velocity_mps.norm(), braking_s = speed / limits.deceleration_mps2;
  const Vec2 rest_m = from.position_m + braking_s / 2 * from.velocity_mps;
  return braking_s + straight_times(0, (rest_m - goal_m).norm(), limits)->total_s();
}

Trajectory fastest_stop(Time start, const State& from, const Vec2& goal_m, const MotionLimits& limits) {
  const Vec2 way = goal_m - from.position_m;
  const double speed = from.velocity_mps.norm();
  const bool is_at_rest = speed < kPlannedRest_mps;
  const bool is_straight = is_at_rest || (std::abs(cross(from.velocity_mps, way)) <= kOnGoal_m * speed &&
                                          from.velocity_mps.dot(way) >= 0);
  if (is_straight)
    if (const auto times = straight_times(is_at_rest ? 0 : speed, way.norm(), limits))
      return motion_along(start, from, {}, *times, goal_m, limits);
  const Vec2 forward = from.velocity_mps / speed;
  Turn best_turn{-limits.deceleration_mps2 * forward, speed / limits.deceleration_mps2};
  const double rest_m =
      (state_after(from, best_turn.acceleration_mps2, best_turn.seconds).position_m - goal_m).norm();
  StraightTimes best = *straight_times(0, rest_m, limits);
  for (int i = 0; i < kTurnDirections; ++i) {
    const Vec2 direction = rotated(forward, 2 * std::numbers::pi * i / kTurnDirections);
    const std::optional<Turn> turn = turn_towards(from, direction, goal_m, limits);
    if (!turn) continue;
    const State turned = state_after(from, turn->acceleration_mps2, turn->seconds);
    const auto times =
        straight_times(turned.velocity_mps.norm(), (goal_m - turned.position_m).norm(), limits);
    if (!times || turn->seconds + times->total_s() >= best_turn.seconds + best.total_s()) continue;
    best = *times;
    best_turn = *turn;
  }
  return motion_along(start, from, best_turn, best, goal_m, limits);
}

}  // namespace sidestep
