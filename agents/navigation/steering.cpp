// SPDX-License-Identifier: Apache-2.0
#include "agents/navigation/steering.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sidestep {
namespace {

using batch::kPredictionLanes;
using batch::kPredictionSamples;

constexpr int kTurnsPerSide = 9;
constexpr double kTurn_rad = 12 * std::numbers::pi / 180;
// Times for which candidate velocities are held. For kSlowDuration_s, slow velocities are also candidates.
constexpr std::array kDurations_s{0.18, 0.37, 0.87};
constexpr double kSlowDuration_s = kDurations_s[1];
constexpr double kSlowFraction = 0.38;  // speed of slow velocities, as a fraction of the speed limit
// Via points lie at these fractions of the distance to the goal, along the line to it and to either side.
constexpr std::array kViaAlong{0.3, 0.5, 0.7};
constexpr std::array kViaLateral{0.06, 0.12, 0.18, 0.25, 0.33, 0.45};
// A via point nearer than this would count as passed immediately.
constexpr double kMinViaDistance_m = 1.25 * batch::kWaypointRadius_m;
// Costs in seconds that are added to the predicted time to the goal.
/// Cost of sharing a robot's position during the first prediction step.
constexpr double kDanger_s = 2;
/// Danger at the end of the prediction, as a fraction of kDanger_s.
constexpr double kFinalDangerFraction = 0.08;
constexpr double kDangerDecayExponent = 1.75;  ///< shape of the decay of danger over time
/// Cost of turning left: robots that all turn right can pass each other.
constexpr double kLeftTurnPenalty_s = 0.1;
constexpr double kSwitchPenalty_s = 0.12;  ///< cost of giving up the previous detour for another candidate
/// The previous detour is kept without a comparison if its danger is below this.
constexpr double kTolerableDanger_s = 0.02;
// Preferred clearances beyond the minimum separation.
constexpr double kMovingClearance_m = 0.035, kStationaryClearance_m = 0.016;
// Danger that occurs later than this after a robot's arrival is ignored.
constexpr float kAfterArrival_s = 0.2F;
// Being this far outside the field is as dangerous as sharing another robot's position.
constexpr float kFullDangerOutside_m = 0.1F;

}  // namespace

Steering::Steering(const Field& field, double radius_m, const MotionLimits& limits,
                   const batch::Kernels& kernels)
    : kernels_(&kernels),
      speed_mps_(limits.speed_mps),
      half_length_m_(static_cast<float>(field.length_m / 2 - radius_m)),
      half_width_m_(static_cast<float>(field.width_m / 2 - radius_m)),
      moving_(limits, kernels),
      candidates_(limits, kernels) {
  for (std::size_t i = 0; i < kPredictionSamples; ++i) {
    const double remaining = 1 - static_cast<double>(i) / static_cast<double>(batch::kPredictionSteps);
    weights_[i] = static_cast<float>(
        kDanger_s *
        (kFinalDangerFraction + (1 - kFinalDangerFraction) * std::pow(remaining, kDangerDecayExponent)));
  }
}

void Steering::clear() {
  moving_.clear();
  min_separations_m_.clear();
  others_.clear();
}

void Steering::add_moving(const State& state, const Intent& intent, double min_separation_m) {
  moving_.add(state, intent);
  min_separations_m_.push_back(min_separation_m + kMovingClearance_m);
}

void Steering::add_stationary(const Vec2& position, double min_separation_m) {
  Other& other = others_.emplace_back();
  std::ranges::fill(other.prediction.x_m, static_cast<float>(position.x()));
  std::ranges::fill(other.prediction.y_m, static_cast<float>(position.y()));
  other.min_separation_m = min_separation_m + kStationaryClearance_m;
}

Intent Steering::choose(const State& at, const Vec2& waypoint, const Vec2& goal, double elapsed_s,
                        LastChoice& last) {
  predict_others();
  candidates_.clear();
  intents_.clear();
  extra_s_.clear();
  const Intent direct{speed_mps_ * (waypoint - at.position_m).stableNormalized(), 0, waypoint, goal};
  add_candidate(at, direct);
  add_last_choice(at, waypoint, goal, elapsed_s, last);
  const std::size_t first_new_candidate = intents_.size();
  evaluate(at.position_m);
  const bool last_choice_is_harmless = first_new_candidate > 1 && danger_s(1) <= kTolerableDanger_s;
  std::size_t chosen = 0;
  if (danger_s(0) > 0 && last_choice_is_harmless) {
    chosen = 1;
  } else if (danger_s(0) > 0) {
    add_velocity_candidates(at, direct);
    add_via_point_candidates(at, goal);
    evaluate(at.position_m);
    chosen = best();
  }
  const bool continues = chosen == 0 ? !last.detour : chosen < first_new_candidate;
  last.changes += continues ? 0 : 1;
  last.detour = chosen == 0 ? std::nullopt : std::optional(intents_[chosen]);
  return intents_[chosen];
}

void Steering::predict_others() {
  moving_.predict();
  for (std::size_t lane = 0; lane < moving_.size(); ++lane)
    others_.push_back({moving_.prediction_of(lane), min_separations_m_[lane]});
  moving_.clear();
  min_separations_m_.clear();
}

void Steering::add_candidate(const State& at, const Intent& intent, double extra_s) {
  candidates_.add(at, intent);
  intents_.push_back(intent);
  extra_s_.push_back(extra_s);
}

void Steering::add_last_choice(const State& at, const Vec2& waypoint, const Vec2& goal, double elapsed_s,
                               const LastChoice& last) {
  if (!last.detour) return;
  Intent again = *last.detour;
  again.goal_m = goal;
  if (again.velocity_duration_s > 0) {
    again.velocity_duration_s -= elapsed_s;
    again.waypoint_m = waypoint;
    if (again.velocity_duration_s > 0) add_candidate(at, again, -kSwitchPenalty_s);
  } else if ((again.waypoint_m - at.position_m).norm() > batch::kWaypointRadius_m) {
    add_candidate(at, again, -kSwitchPenalty_s);
  }
}

void Steering::add_velocity_candidates(const State& at, const Intent& direct) {
  Intent intent = direct;
  for (const double duration_s : kDurations_s) {
    intent.velocity_duration_s = duration_s;
    intent.velocity_mps = Vec2::Zero();
    add_candidate(at, intent);
    for (int turn = -kTurnsPerSide; turn <= kTurnsPerSide; ++turn) {
      const Vec2 velocity = rotated(direct.velocity_mps, turn * kTurn_rad);
      const double extra = turn > 0 ? kLeftTurnPenalty_s : 0;
      intent.velocity_mps = velocity;
      add_candidate(at, intent, extra);
      if (duration_s != kSlowDuration_s) continue;
      intent.velocity_mps = kSlowFraction * velocity;
      add_candidate(at, intent, extra);
    }
  }
}

void Steering::add_via_point_candidates(const State& at, const Vec2& goal) {
  const Vec2 to_goal = goal - at.position_m, left(-to_goal.y(), to_goal.x());
  for (const double along : kViaAlong) {
    for (const double lateral : kViaLateral) {
      if (std::hypot(along, lateral) * to_goal.norm() < kMinViaDistance_m) continue;
      const Vec2 middle = at.position_m + along * to_goal;
      add_candidate(at, {{0, 0}, 0, middle - lateral * left, goal});
      add_candidate(at, {{0, 0}, 0, middle + lateral * left, goal}, kLeftTurnPenalty_s);
    }
  }
}

std::size_t Steering::first_reachable_sample(const Other& other, const Vec2& from_m) const {
  const double step_m = speed_mps_ * batch::kPredictionStep_s;
  std::size_t i = 0;
  // Before sample i + 1, the robot travels at most i + 1 steps, and the other robot is at most one step
  // nearer than at that sample.
  const auto max_reach_m = [&] { return other.min_separation_m + step_m * static_cast<double>(i + 2); };
  while (i < batch::kPredictionSteps && std::hypot(other.prediction.x_m[i + 1] - from_m.x(),
                                                   other.prediction.y_m[i + 1] - from_m.y()) > max_reach_m())
    ++i;
  return i;
}

void Steering::evaluate(const Vec2& at) {
  const batch::PredictionKernels& kernels = kernels_->prediction;
  candidates_.predict();
  const std::size_t blocks = candidates_.block_count();
  dangers_.assign(blocks, batch::PredictionRow{});
  kernels.add_outside_danger(half_length_m_, half_width_m_, kFullDangerOutside_m, weights_,
                             candidates_.blocks(), blocks, dangers_.data());
  for (const Other& other : others_) {
    const std::size_t from = first_reachable_sample(other, at);
    kernels.add_proximity_danger(other.prediction, from, static_cast<float>(other.min_separation_m), weights_,
                                 kAfterArrival_s, candidates_.blocks(), blocks, dangers_.data());
  }
}

double Steering::danger_s(std::size_t lane) const {
  return dangers_[lane / kPredictionLanes].lane[lane % kPredictionLanes];
}

std::size_t Steering::best() const {
  const auto cost = [&](std::size_t lane) {
    return candidates_.arrival_s(lane) + extra_s_[lane] + danger_s(lane);
  };
  std::size_t best = 0;
  for (std::size_t lane = 1; lane < candidates_.size(); ++lane) {
    if (cost(lane) < cost(best)) best = lane;
  }
  return best;
}

}  // namespace sidestep
