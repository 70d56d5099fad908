// SPDX-License-Identifier: Apache-2.0
// Drives robots in thought and finds where they meet; see vectors.hpp. What comes of it is wished for, so
// products must not be contracted: every machine has to get the same bits.
#define SIDESTEP_SINGLE_PRECISION
#include "agents/batch/vectors.hpp"

namespace sidestep::batch {
namespace {

// Of its deceleration a robot means to use so much, and slowly it creeps up to its goal.
constexpr Number kBraking = 0.8F, kCreep_mps = 0.5F;
// Speeds whose squares differ by less than a tenth are the same: then a robot turns.
constexpr Number kSlower2 = 0.9F;
constexpr Number kNothing = 1e-9F;
constexpr Number kNothing_s = 1e-4F;  // longer than rounding

struct Driven {
  Vector x, y, vx, vy;
  Vector is_past;  // 1 or 0
  Vector to_go_x, to_go_y, to_go, rest;
};

/// From where the robots are to what they make for, and the length of their ways.
void look(const CourseBlock& c, std::size_t at, const Vector& leg, Driven& d) {
  const Vector way_x = load(c.way_x, at) - d.x, way_y = load(c.way_y, at) - d.y;
  const Vector goal_x = load(c.goal_x, at) - d.x, goal_y = load(c.goal_y, at) - d.y;
  const auto passes = way_x * way_x + way_y * way_y < all(static_cast<Number>(kPassed_m * kPassed_m));
  d.is_past = passes ? all(1) : d.is_past;
  const auto is_past = d.is_past > all(0.5F);
  d.to_go_x = is_past ? goal_x : way_x;
  d.to_go_y = is_past ? goal_y : way_y;
  d.to_go = root(d.to_go_x * d.to_go_x + d.to_go_y * d.to_go_y);
  d.rest = d.to_go + (is_past ? all(0) : leg);
}

/// How long robots take for what is left of their ways, as fast as they may.
Vector time_to_go_s(const DrivingSettings& s, const Driven& d) {
  const Number f = s.acceleration_mps2, b = s.deceleration_mps2;
  const Vector zero = all(0);
  const Vector along = d.to_go > all(kNothing) ? (d.vx * d.to_go_x + d.vy * d.to_go_y) / d.to_go : zero;
  const Vector highest = root((2 * f * b * d.rest + b * along * along) * (1 / (f + b)));
  const Vector peak = smaller(all(s.speed_mps), larger(along, highest));
  const Vector changing_m = (peak * peak - along * along) * (0.5F / f) + peak * peak * (0.5F / b);
  const Vector at_peak_s = larger(d.rest - changing_m, zero) / larger(peak, all(kNothing));
  const Vector goes = (peak - along) * (1 / f) + at_peak_s + peak * (1 / b);
  // Who cannot stop there any more comes back.
  const Vector beyond = along * along * (0.5F / b) - d.rest;
  const Vector comes_back = along * (1 / b) + root(larger(beyond, zero) * (2 * (f + b) / (f * b)));
  const Vector overshoots = beyond > zero ? comes_back : goes;
  return along > zero ? overshoots : goes;
}

/// Notes when, and what is needed to say how long it takes from there.
template <typename Mask>
void note(const Driven& d, const Mask& which, Number now_s, Driven& then, Vector& when) {
  when = which ? all(now_s) : when;
  then.vx = which ? d.vx : then.vx;
  then.vy = which ? d.vy : then.vy;
  then.to_go_x = which ? d.to_go_x : then.to_go_x;
  then.to_go_y = which ? d.to_go_y : then.to_go_y;
  then.to_go = which ? d.to_go : then.to_go;
  then.rest = which ? d.rest : then.rest;
}

/// One step towards velocities.
void advance(const DrivingSettings& s, const Vector& desired_x, const Vector& desired_y, Driven& d) {
  constexpr Number kStep = static_cast<Number>(kPredictionStep_s);
  Vector change_x = desired_x - d.vx, change_y = desired_y - d.vy;
  const Vector change = root(change_x * change_x + change_y * change_y);
  const auto slows = desired_x * desired_x + desired_y * desired_y < kSlower2 * (d.vx * d.vx + d.vy * d.vy);
  const Vector most = slows ? all(s.deceleration_mps2 * kStep) : all(s.acceleration_mps2 * kStep);
  const Vector scale = change > most ? most / change : all(1);
  change_x = change_x * scale;
  change_y = change_y * scale;
  d.x = d.x + kStep * (d.vx + 0.5F * change_x);
  d.y = d.y + kStep * (d.vy + 0.5F * change_y);
  d.vx = d.vx + change_x;
  d.vy = d.vy + change_y;
}

void drive(const DrivingSettings& s, const CourseBlock& c, std::size_t at, PredictionBlock& f) {
  constexpr Number kStep = static_cast<Number>(kPredictionStep_s);
  const Vector zero = all(0), top = all(s.speed_mps);
  const Vector leg_x = load(c.goal_x, at) - load(c.way_x, at), leg_y = load(c.goal_y, at) - load(c.way_y, at);
  const Vector leg = root(leg_x * leg_x + leg_y * leg_y);
  Driven d{
      load(c.x_m, at), load(c.y_m, at), load(c.vx_mps, at), load(c.vy_mps, at), zero, zero, zero, zero, zero};
  d.is_past = leg < all(kNothing) ? all(1) : zero;
  // Where a robot's arrival can be told.
  Vector when = all(-1);
  Driven then = d;
  const Number near_m = s.speed_mps * s.speed_mps / (2 * kBraking * s.deceleration_mps2);
  for (std::size_t i = 0;; ++i) {
    store(f.x_m[i], at, d.x);
    store(f.y_m[i], at, d.y);
    const Vector held = load(c.hold_s, at) - static_cast<Number>(i) * kStep;
    const auto holds = held > all(kNothing_s);
    const Vector before = d.is_past;
    look(c, at, leg, d);
    if (i == kPredictionSteps) break;
    d.is_past = holds ? before : d.is_past;
    const Vector brakes = root(2 * kBraking * s.deceleration_mps2 * d.rest) - s.deceleration_mps2 * kStep / 2;
    const Vector speed = smaller(top, larger(brakes, smaller(d.rest / kStep, all(kCreep_mps))));
    const Vector share = d.to_go > all(kNothing) ? speed / d.to_go : zero;
    const Vector desired_x = holds ? load(c.hold_vx, at) : share * d.to_go_x;
    const Vector desired_y = holds ? load(c.hold_vy, at) : share * d.to_go_y;
    note(d, (when < zero) & ~holds & (d.rest < all(near_m)), static_cast<Number>(i) * kStep, then, when);
    advance(s, desired_x, desired_y, d);
  }
  note(d, when < zero, kPredictionSteps * kStep, then, when);
  store(f.arrival_s, at, when + time_to_go_s(s, then));
}

void drive(const DrivingSettings& settings, const CourseBlock* courses, std::size_t blocks,
           PredictionBlock* forecasts) {
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth)
      drive(settings, courses[block], at, forecasts[block]);
  }
}

/// By how much the way from a to b comes too near to the origin.
Vector too_near(const Vector& ax, const Vector& ay, const Vector& bx, const Vector& by, Number inverse) {
  const Vector dx = bx - ax, dy = by - ay;
  const Vector way = larger(dx * dx + dy * dy, all(kNothing));
  const Vector share = smaller(all(1), larger(all(0), -(ax * dx + ay * dy) / way));
  const Vector cx = ax + share * dx, cy = ay + share * dy;
  const Vector deep = larger(all(0), 1 - (cx * cx + cy * cy) * inverse);
  return deep * deep;
}

void meet(const Prediction& one, std::size_t from, Number min_separation_m, const Number* weights, Number after_s,
          const PredictionBlock* lanes, std::size_t blocks, PredictionRow* dangers) {
  const Vector zero = all(0), full = all(1);
  const Number inverse = 1 / (min_separation_m * min_separation_m);
  for (std::size_t block = 0; block < blocks; ++block) {
    const PredictionBlock& f = lanes[block];
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth) {
      const Vector last = load(f.arrival_s, at) + after_s;
      Vector danger = load(dangers[block], at);
      Vector ax = load(f.x_m[from], at) - one.x_m[from], ay = load(f.y_m[from], at) - one.y_m[from];
      for (std::size_t i = from + 1; i < kPredictionSamples; ++i) {
        const Vector bx = load(f.x_m[i], at) - one.x_m[i], by = load(f.y_m[i], at) - one.y_m[i];
        const Vector counts =
            last < all(static_cast<Number>(i) * static_cast<Number>(kPredictionStep_s)) ? zero : full;
        const Vector deep = too_near(ax, ay, bx, by, inverse);
        danger = danger + weights[i] * counts * deep;
        ax = bx;
        ay = by;
      }
      store(dangers[block], at, danger);
    }
  }
}

void leave(Number half_length_m, Number half_width_m, Number deep_m, const Number* weights,
           const PredictionBlock* lanes, std::size_t blocks, PredictionRow* dangers) {
  const Vector zero = all(0), full = all(1);
  const Number inverse = 1 / deep_m;
  for (std::size_t block = 0; block < blocks; ++block) {
    const PredictionBlock& f = lanes[block];
    for (std::size_t at = 0; at < kPredictionLanes; at += kWidth) {
      Vector danger = load(dangers[block], at);
      for (std::size_t i = 1; i < kPredictionSamples; ++i) {
        const Vector x = load(f.x_m[i], at), y = load(f.y_m[i], at);
        const Vector out = larger(larger(x, -x) - half_length_m, larger(y, -y) - half_width_m);
        danger = danger + weights[i] * smaller(full, larger(zero, out * inverse));
      }
      store(dangers[block], at, danger);
    }
  }
}

}  // namespace

const PredictionKernels SIDESTEP_KERNELS{drive, meet, leave};

}  // namespace sidestep::batch
