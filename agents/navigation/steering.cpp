// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/steering.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sidestep {
namespace {

using batch::kPredictionLanes;
using batch::kPredictionSamples;

constexpr double kPi = 3.14159265358979323846;
constexpr int kTurnsToASide = 9;
constexpr double kTurn_rad = 12 * kPi / 180;
// Velocities are held for so long; one of them also slowly.
constexpr std::array kHolds_s{0.18, 0.37, 0.87};
constexpr double kSlowHold_s = kHolds_s[1];
constexpr double kSlow = 0.38;  // of the speed limit
// Where bends lie: along the way, and beside it, as shares of its length.
constexpr std::array kAlong{0.3, 0.5, 0.7};
constexpr std::array kBeside{0.06, 0.12, 0.18, 0.25, 0.33, 0.45};
// Nearer bends lead nowhere else.
constexpr double kNearestBend_m = 1.25 * batch::kPassed_m;
// What comes so much later than a robot has arrived is not for it to care about.
constexpr float kAfterArrival_s = 0.2F;
// So far outside the field is as bad as in another robot's place.
constexpr float kDeepOutside_m = 0.1F;

}  // namespace

Steering::Steering(const Field& field, double radius_m, const MotionLimits& limits,
                   const SteeringSettings& settings, const batch::Kernels& kernels)
    : kernels_(&kernels),
      settings_(settings),
      speed_mps_(limits.speed_mps),
      half_length_m_(static_cast<float>(field.length_m / 2 - radius_m)),
      half_width_m_(static_cast<float>(field.width_m / 2 - radius_m)),
      moving_(limits, kernels),
      offered_(limits, kernels) {
  for (std::size_t i = 0; i < kPredictionSamples; ++i) {
    const double to_come = 1 - static_cast<double>(i) / static_cast<double>(batch::kPredictionSteps);
    const double late = settings_.late_danger;
    weights_[i] =
        static_cast<float>(settings_.danger_s * (late + (1 - late) * std::pow(to_come, settings_.fade)));
  }
}

void Steering::clear() {
  moving_.clear();
  keeps_m_.clear();
  others_.clear();
}

void Steering::add_moving(const State& state, const Intent& intent, double min_separation_m) {
  moving_.add(state, intent);
  keeps_m_.push_back(min_separation_m + settings_.extra_clearance_m);
}

void Steering::add_standing(const Vec2& place, double min_separation_m) {
  Other& other = others_.emplace_back();
  std::ranges::fill(other.forecast.x_m, static_cast<float>(place.x()));
  std::ranges::fill(other.forecast.y_m, static_cast<float>(place.y()));
  other.min_separation_m = min_separation_m + settings_.standing_room_m;
}

Intent Steering::choose(const State& at, const Vec2& waypoint, const Vec2& goal, double since_s,
                        LastChoice& last) {
  forecast_others();
  offered_.clear();
  intents_.clear();
  extra_s_.clear();
  const Intent direct{speed_mps_ * (waypoint - at.position_m).stableNormalized(), 0, waypoint, goal};
  offer(at, direct);
  offer_last(at, waypoint, goal, since_s, last);
  const std::size_t first_new = intents_.size();
  weigh(at.position_m);
  const bool goes_on_well = first_new > 1 && danger_s(1) <= settings_.harmless_s;
  std::size_t chosen = 0;
  if (danger_s(0) > 0 && goes_on_well) {
    chosen = 1;
  } else if (danger_s(0) > 0) {
    offer_turns(at, direct);
    offer_bends(at, goal);
    weigh(at.position_m);
    chosen = best();
  }
  const bool goes_on = chosen == 0 ? !last.way_round : chosen < first_new;
  last.changes += goes_on ? 0 : 1;
  last.way_round = chosen == 0 ? std::nullopt : std::optional(intents_[chosen]);
  return intents_[chosen];
}

void Steering::forecast_others() {
  moving_.drive();
  for (std::size_t lane = 0; lane < moving_.size(); ++lane)
    others_.push_back({moving_.of(lane), keeps_m_[lane]});
  moving_.clear();
  keeps_m_.clear();
}

void Steering::offer(const State& at, const Intent& intent, double extra_s) {
  offered_.add(at, intent);
  intents_.push_back(intent);
  extra_s_.push_back(extra_s);
}

void Steering::offer_last(const State& at, const Vec2& waypoint, const Vec2& goal, double since_s,
                          const LastChoice& last) {
  if (!last.way_round) return;
  Intent again = *last.way_round;
  again.goal_m = goal;
  if (again.hold_s > 0) {
    again.hold_s -= since_s;
    again.waypoint_m = waypoint;
    if (again.hold_s > 0) offer(at, again, -settings_.change_s);
  } else if ((again.waypoint_m - at.position_m).norm() > batch::kPassed_m) {
    offer(at, again, -settings_.change_s);
  }
}

void Steering::offer_turns(const State& at, const Intent& direct) {
  Intent intent = direct;
  for (const double hold : kHolds_s) {
    intent.hold_s = hold;
    intent.velocity_mps = Vec2::Zero();
    offer(at, intent);
    for (int turn = -kTurnsToASide; turn <= kTurnsToASide; ++turn) {
      const Vec2 velocity = rotated(direct.velocity_mps, turn * kTurn_rad);
      const double extra = turn > 0 ? settings_.left_s : 0;
      intent.velocity_mps = velocity;
      offer(at, intent, extra);
      if (hold != kSlowHold_s) continue;
      intent.velocity_mps = kSlow * velocity;
      offer(at, intent, extra);
    }
  }
}

void Steering::offer_bends(const State& at, const Vec2& goal) {
  const Vec2 way = goal - at.position_m, left(-way.y(), way.x());
  for (const double along : kAlong) {
    for (const double beside : kBeside) {
      if (std::hypot(along, beside) * way.norm() < kNearestBend_m) continue;
      const Vec2 middle = at.position_m + along * way;
      offer(at, {{0, 0}, 0, middle - beside * left, goal});
      offer(at, {{0, 0}, 0, middle + beside * left, goal}, settings_.left_s);
    }
  }
}

std::size_t Steering::first_reach(const Other& other, const Vec2& from_m) const {
  const double step_m = speed_mps_ * batch::kPredictionStep_s;
  std::size_t i = 0;
  // However it goes, it is not farther away than that, and the other one comes no nearer than that before.
  const auto reach_m = [&] { return other.min_separation_m + step_m * static_cast<double>(i + 2); };
  while (i < batch::kPredictionSteps && std::hypot(other.forecast.x_m[i + 1] - from_m.x(),
                                                 other.forecast.y_m[i + 1] - from_m.y()) > reach_m())
    ++i;
  return i;
}

void Steering::weigh(const Vec2& at) {
  const batch::PredictionKernels& kernels = kernels_->forecasting;
  offered_.drive();
  const std::size_t blocks = offered_.block_count();
  dangers_.assign(blocks, batch::PredictionRow{});
  kernels.leave(half_length_m_, half_width_m_, kDeepOutside_m, weights_, offered_.blocks(), blocks,
                dangers_.data());
  for (const Other& other : others_) {
    const std::size_t from = first_reach(other, at);
    kernels.meet(other.forecast, from, static_cast<float>(other.min_separation_m), weights_, kAfterArrival_s,
                 offered_.blocks(), blocks, dangers_.data());
  }
}

double Steering::danger_s(std::size_t lane) const {
  return dangers_[lane / kPredictionLanes].lane[lane % kPredictionLanes];
}

std::size_t Steering::best() const {
  const auto cost = [&](std::size_t lane) {
    return offered_.arrival_s(lane) + extra_s_[lane] + danger_s(lane);
  };
  std::size_t best = 0;
  for (std::size_t lane = 1; lane < offered_.size(); ++lane) {
    if (cost(lane) < cost(best)) best = lane;
  }
  return best;
}

}  // namespace sidestep
