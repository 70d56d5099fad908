// SPDX-License-Identifier: Apache-2.0
#include "agents/agent/stranger_watch.hpp"

#include <algorithm>

#include "agents/agent/planning_distances.hpp"
#include "common/motion/robot_model.hpp"

namespace sidestep {
namespace {

/// A robot that is faster is not kept from driving; see DeadlockRecovery.
constexpr double kSlow_mps = 0.3;
/// A stranger that stops the robot for longer is named, and forgotten when it has not stopped it for a while:
/// a robot whose goal is too near to a stranger approaches again and again.
constexpr Duration kNamedAfter{200'000'000}, kForgottenAfter{1'000'000'000};
/// About the time from an observation until a slow robot rests.
constexpr Duration kReaction{200'000'000};

}  // namespace

void StrangerWatch::update(const SearchQuery& query, bool is_free, Time now) {
  if (is_free || !(query.at_start.velocity_mps.norm() <= kSlow_mps)) return;
  const Vec2 desired = limit_acceleration(query.desired_mps2, query.at_start.velocity_mps,
                                          query.limited(rules_.limits), query.hold_time);
  const Trajectory trajectory = accelerate_then_stop(query.start, query.at_start, desired, query.hold_time,
                                                     rules_.limits.deceleration_mps2);
  const MovingObstacle* nearest = nullptr;
  const auto distance_m = [&](const MovingObstacle& stranger) {
    return (stranger.position_m - query.at_start.position_m).norm();
  };
  for (const MovingObstacle& stranger : query.moving) {
    if (nearest && distance_m(stranger) >= distance_m(*nearest)) continue;
    if (!is_passively_safe(trajectory, stranger, required_separation_m(rules_))) nearest = &stranger;
  }
  if (!nearest) return;
  if (!stranger_) since_ = now;
  last_ = now;
  stranger_ = Blockage{msg::BlockReason::BLOCK_STRANGER, 0, nearest->position_m, query.at_start.position_m,
                       nearest->speed_mps};
}

void StrangerWatch::close_cycle(Time now) {
  if (now < last_ || now - last_ > kForgottenAfter) stranger_.reset();
}

bool StrangerWatch::is_at(const Vec2& goal_m) const {
  if (!stranger_) return false;
  const double reach_m = stranger_->blocker_speed_mps * to_seconds(kReaction);
  return (stranger_->blocker_m - goal_m).norm() < required_separation_m(rules_) + rules_.radius_m + reach_m;
}

std::optional<Blockage> StrangerWatch::lasting() const {
  return last_ - since_ >= kNamedAfter ? stranger_ : std::nullopt;
}

}  // namespace sidestep
