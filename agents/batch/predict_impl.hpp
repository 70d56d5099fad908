// SPDX-License-Identifier: Apache-2.0
// Prediction kernels for one instruction set; see vectors.hpp. Their results enter proposals, so every
// machine must compute the same bits. Multiplications and additions must therefore not be fused.
#define SIDESTEP_SINGLE_PRECISION
#include "agents/batch/vectors.hpp"

namespace sidestep::batch {
namespace {

// Fraction of the deceleration limit that a predicted robot uses.
constexpr Number kBrakingShare = 0.8F;
// Lower bound of the approach speed, unless the goal is less than a step away.
constexpr Number kMinApproachSpeed_mps = 0.5F;
// A robot brakes if its desired squared speed is below this fraction of its current squared speed. Otherwise
// it turns or accelerates.
constexpr Number kSlowdownRatio2 = 0.9F;
constexpr Number kEpsilon = 1e-9F;
constexpr Number kEpsilon_s = 1e-4F;  // exceeds rounding errors

/// Predicted states, with each robot's offset and distance to its next target and its remaining path length.
struct Rollout {
  Vector x, y, vx, vy;
  Vector past_waypoint;  // 1 once the robot has passed its waypoint, otherwise 0
  Vector to_go_x, to_go_y, to_go, remaining;
};

/// Updates the offsets to the targets (the waypoint, or the goal after it) and the remaining path lengths.
void update_target(const CourseBlock& c, std::size_t at, const Vector& leg, Rollout& r) {
  const Vector waypoint_x = load(c.waypoint_x, at) - r.x, waypoint_y = load(c.waypoint_y, at) - r.y;
  const Vector goal_x = load(c.goal_x, at) - r.x, goal_y = load(c.goal_y, at) - r.y;
  const auto is_at_waypoint = waypoint_x * waypoint_x + waypoint_y * waypoint_y <
                              broadcast(static_cast<Number>(kWaypointRadius_m * kWaypointRadius_m));
  r.past_waypoint = is_at_waypoint ? broadcast(1) : r.past_waypoint;
  const auto past_waypoint = r.past_waypoint > broadcast(0.5F);
  r.to_go_x = past_waypoint ? goal_x : waypoint_x;
  r.to_go_y = past_waypoint ? goal_y : waypoint_y;
  r.to_go = square_root(r.to_go_x * r.to_go_x + r.to_go_y * r.to_go_y);
  r.remaining = r.to_go + (past_waypoint ? broadcast(0) : leg);
}

/// Minimum time to drive the remaining paths within the motion limits.
Vector time_to_go_s(const DrivingSettings& s, const Rollout& r) {
  const Number f = s.acceleration_mps2, b = s.deceleration_mps2;
  const Vector zero = broadcast(0);
  const Vector along = r.to_go > broadcast(kEpsilon) ? (r.vx * r.to_go_x + r.vy * r.to_go_y) / r.to_go : zero;
  const Vector unlimited_peak = square_root((2 * f * b * r.remaining + b * along * along) * (1 / (f + b)));
  const Vector peak = min(broadcast(s.speed_mps), max(along, unlimited_peak));
  const Vector ramps_m = (peak * peak - along * along) * (0.5F / f) + peak * peak * (0.5F / b);
  const Vector at_peak_s = max(r.remaining - ramps_m, zero) / max(peak, broadcast(kEpsilon));
  const Vector normal_s = (peak - along) * (1 / f) + at_peak_s + peak * (1 / b);
  // A robot that can no longer stop at its goal overshoots it and returns.
  const Vector overshoot_m = along * along * (0.5F / b) - r.remaining;
  const Vector return_s = along * (1 / b) + square_root(max(overshoot_m, zero) * (2 * (f + b) / (f * b)));
  const Vector with_overshoot_s = overshoot_m > zero ? return_s : normal_s;
  return along > zero ? with_overshoot_s : normal_s;
}

/// Where `mask` is set, records the time and the state in which the robot begins to brake for its goal.
template <typename Mask>
void record_braking(const Rollout& r, const Mask& mask, Number now_s, Rollout& braking, Vector& braking_s) {
  braking_s = mask ? broadcast(now_s) : braking_s;
  braking.vx = mask ? r.vx : braking.vx;
  braking.vy = mask ? r.vy : braking.vy;
  braking.to_go_x = mask ? r.to_go_x : braking.to_go_x;
  braking.to_go_y = mask ? r.to_go_y : braking.to_go_y;
  braking.to_go = mask ? r.to_go : braking.to_go;
  braking.remaining = mask ? r.remaining : braking.remaining;
}

/// Advances by one step in which velocities approach the desired ones within the acceleration limits.
void advance(const DrivingSettings& s, const Vector& desired_x, const Vector& desired_y, Rollout& r) {
  constexpr Number kStep = static_cast<Number>(kPredictionStep_s);
  Vector change_x = desired_x - r.vx, change_y = desired_y - r.vy;
  const Vector change = square_root(change_x * change_x + change_y * change_y);
  const auto slows_down =
      desired_x * desired_x + desired_y * desired_y < kSlowdownRatio2 * (r.vx * r.vx + r.vy * r.vy);
  const Vector max_change =
      slows_down ? broadcast(s.deceleration_mps2 * kStep) : broadcast(s.acceleration_mps2 * kStep);
  const Vector scale = change > max_change ? max_change / change : broadcast(1);
  change_x = change_x * scale;
  change_y = change_y * scale;
  r.x = r.x + kStep * (r.vx + 0.5F * change_x);
  r.y = r.y + kStep * (r.vy + 0.5F * change_y);
  r.vx = r.vx + change_x;
  r.vy = r.vy + change_y;
}

void roll_out(const DrivingSettings& s, const CourseBlock& c, std::size_t at, PredictionBlock& p) {
  constexpr Number kStep = static_cast<Number>(kPredictionStep_s);
  const Vector zero = broadcast(0), max_speed = broadcast(s.speed_mps);
  const Vector leg_x = load(c.goal_x, at) - load(c.waypoint_x, at),
               leg_y = load(c.goal_y, at) - load(c.waypoint_y, at);
  const Vector leg = square_root(leg_x * leg_x + leg_y * leg_y);
  Rollout r{
      load(c.x_m, at), load(c.y_m, at), load(c.vx_mps, at), load(c.vy_mps, at), zero, zero, zero, zero, zero};
  r.past_waypoint = leg < broadcast(kEpsilon) ? broadcast(1) : zero;
  // The time from which the remaining motion is a simple trapezoidal profile, and the state at that time.
  Vector braking_s = broadcast(-1);
  Rollout braking = r;
  const Number braking_distance_m = s.speed_mps * s.speed_mps / (2 * kBrakingShare * s.deceleration_mps2);
  for (std::size_t i = 0;; ++i) {
    store(p.x_m[i], at, r.x);
    store(p.y_m[i], at, r.y);
    const Vector remaining_hold_s = load(c.velocity_duration_s, at) - static_cast<Number>(i) * kStep;
    const auto is_holding = remaining_hold_s > broadcast(kEpsilon_s);
    const Vector was_past_waypoint = r.past_waypoint;
    update_target(c, at, leg, r);
    if (i == kPredictionSteps) break;
    r.past_waypoint = is_holding ? was_past_waypoint : r.past_waypoint;
    const Vector braking_speed =
        square_root(2 * kBrakingShare * s.deceleration_mps2 * r.remaining) - s.deceleration_mps2 * kStep / 2;
    const Vector speed =
        min(max_speed, max(braking_speed, min(r.remaining / kStep, broadcast(kMinApproachSpeed_mps))));
    const Vector fraction = r.to_go > broadcast(kEpsilon) ? speed / r.to_go : zero;
    const Vector desired_x = is_holding ? load(c.intent_vx, at) : fraction * r.to_go_x;
    const Vector desired_y = is_holding ? load(c.intent_vy, at) : fraction * r.to_go_y;
    record_braking(r, (braking_s < zero) & ~is_holding & (r.remaining < broadcast(braking_distance_m)),
                   static_cast<Number>(i) * kStep, braking, braking_s);
    advance(s, desired_x, desired_y, r);
  }
  record_braking(r, braking_s < zero, kPredictionSteps * kStep, braking, braking_s);
  store(p.arrival_s, at, braking_s + time_to_go_s(s, braking));
}

void roll_out(const DrivingSettings& settings, const CourseBlock* courses, std::size_t blocks,
              PredictionBlock* predictions) {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth)
      roll_out(settings, courses[block], at, predictions[block]);
  }
}

/// (1 - distance² * inverse)², where `distance` is the distance of the segment ab from the origin; 0 if
/// distance² * inverse exceeds 1.
Vector proximity(const Vector& ax, const Vector& ay, const Vector& bx, const Vector& by, Number inverse) {
  const Vector dx = bx - ax, dy = by - ay;
  const Vector length2 = max(dx * dx + dy * dy, broadcast(kEpsilon));
  const Vector fraction = min(broadcast(1), max(broadcast(0), -(ax * dx + ay * dy) / length2));
  const Vector cx = ax + fraction * dx, cy = ay + fraction * dy;
  const Vector depth = max(broadcast(0), 1 - (cx * cx + cy * cy) * inverse);
  return depth * depth;
}

void add_proximity_danger(const Prediction& reference, std::size_t from, Number min_separation_m,
                          const Number* weights, Number after_arrival_s, const PredictionBlock* lanes,
                          std::size_t blocks, PredictionRow* dangers) {
  const Vector zero = broadcast(0), full = broadcast(1);
  const Number inverse = 1 / (min_separation_m * min_separation_m);
  for (std::size_t block = 0; block < blocks; ++block) {
    const PredictionBlock& p = lanes[block];
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth) {
      const Vector last = load(p.arrival_s, at) + after_arrival_s;
      Vector danger = load(dangers[block], at);
      Vector ax = load(p.x_m[from], at) - reference.x_m[from],
             ay = load(p.y_m[from], at) - reference.y_m[from];
      for (std::size_t i = from + 1; i < kPredictionSamples; ++i) {
        const Vector bx = load(p.x_m[i], at) - reference.x_m[i], by = load(p.y_m[i], at) - reference.y_m[i];
        const Vector is_counted =
            last < broadcast(static_cast<Number>(i) * static_cast<Number>(kPredictionStep_s)) ? zero : full;
        const Vector depth = proximity(ax, ay, bx, by, inverse);
        danger = danger + weights[i] * is_counted * depth;
        ax = bx;
        ay = by;
      }
      store(dangers[block], at, danger);
    }
  }
}

void add_outside_danger(Number half_length_m, Number half_width_m, Number full_danger_m,
                        const Number* weights, const PredictionBlock* lanes, std::size_t blocks,
                        PredictionRow* dangers) {
  const Vector zero = broadcast(0), full = broadcast(1);
  const Number inverse = 1 / full_danger_m;
  for (std::size_t block = 0; block < blocks; ++block) {
    const PredictionBlock& p = lanes[block];
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth) {
      Vector danger = load(dangers[block], at);
      for (std::size_t i = 1; i < kPredictionSamples; ++i) {
        const Vector x = load(p.x_m[i], at), y = load(p.y_m[i], at);
        const Vector outside_m = max(max(x, -x) - half_length_m, max(y, -y) - half_width_m);
        danger = danger + weights[i] * min(full, max(zero, outside_m * inverse));
      }
      store(dangers[block], at, danger);
    }
  }
}

}  // namespace

const PredictionKernels SIDESTEP_KERNELS{roll_out, add_proximity_danger, add_outside_danger};

}  // namespace sidestep::batch
