// SPDX-License-Identifier: Apache-2.0
#include "agents/safety/uncontrolled_body.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sidestep {
namespace {

constexpr double kSpread = 0.1;
// Covers errors of the expected motion.
constexpr double kAllowance_m = 0.03;
// A robot that cannot avoid the body completely deviates from its stop only if it gains this much distance.
constexpr double kMinGain_m = 0.01;
// Required distance from a body whose direction of motion is unknown.
constexpr double kUnknownDirection_m = 0.4;
// Two bodies with a relative speed of 4 m/s approach by 2 cm in this time.
constexpr Duration kSampling{5'000'000};
constexpr Duration kDrivingOnStep{50'000'000}, kMaxDrivingOn{400'000'000};

}  // namespace

double UncontrolledBody::distance_from_path_m(const Vec2& position_m) const {
  const Vec2 offset = position_m - reach.position_m;
  if (offset.dot(reach.velocity_mps) <= 0) return offset.norm();
  return std::abs(reach.velocity_mps.x() * offset.y() - reach.velocity_mps.y() * offset.x()) /
         reach.velocity_mps.norm();
}

double UncontrolledBody::required_distance_m(const Vec2& position_m) const {
  if (reach.velocity_mps.isZero(0)) return kUnknownDirection_m;
  const double ahead_m = (position_m - reach.position_m).dot(reach.velocity_mps) / reach.velocity_mps.norm();
  return separation_m + kAllowance_m + kSpread * std::max(ahead_m, 0.0);
}

double excess_distance_m(const Trajectory& trajectory, Time from, const UncontrolledBody& body) {
  double spare_m = std::numeric_limits<double>::infinity();
  for (Time t = from; t < trajectory.end(); t += kSampling) {
    const double age_s = to_seconds(t - body.reach.observed_at);
    const Vec2 body_m = body.reach.position_m + age_s * body.reach.velocity_mps;
    const double distance_m = (trajectory.state_at(t).position_m - body_m).norm();
    spare_m = std::min(spare_m, distance_m - body.separation_m - kAllowance_m);
  }
  // When the robot comes to rest, the body may still be approaching, or may already have passed.
  UncontrolledBody later = body;
  later.reach.position_m +=
      to_seconds(std::max(from, trajectory.end()) - body.reach.observed_at) * body.reach.velocity_mps;
  const Vec2 rest_m = trajectory.rest_position_m();
  const double required_m = std::min(later.required_distance_m(rest_m), body.required_distance_m(rest_m));
  return std::min(spare_m, later.distance_from_path_m(rest_m) - required_m);
}

namespace {

/// Whether the robot keeps this spare distance if it drives on for a while after the candidate's first phase.
bool avoids_by_driving_on(const Trajectory& candidate, const UncontrolledBody& body, double min_spare_m,
                          double deceleration_mps2) {
  if (candidate.phases().empty()) return excess_distance_m(candidate, candidate.start(), body) >= min_spare_m;
  for (Duration longer{0}; longer <= kMaxDrivingOn; longer += kDrivingOnStep) {
    Trajectory trajectory(candidate.start(), candidate.at_start());
    trajectory.append(candidate.phases().front().duration, candidate.phases().front().acceleration_mps2);
    trajectory.append(longer, Vec2(0, 0));
    append_stop(trajectory, deceleration_mps2);
    if (excess_distance_m(trajectory, trajectory.start(), body) >= min_spare_m) return true;
  }
  return false;
}

/// Whether the candidate rests off the body's path, or no deeper in it than the stop does.
bool rests_safely(const Vec2& rest_m, const Vec2& stop_m, const UncontrolledBody& body) {
  const double distance_m = body.distance_from_path_m(rest_m);
  if (distance_m >= body.required_distance_m(rest_m)) return true;
  const double out_m = distance_m - body.distance_from_path_m(stop_m);
  const Vec2& velocity_mps = body.reach.velocity_mps;
  const double towards_m =
      velocity_mps.isZero(0) ? 0 : (stop_m - rest_m).dot(velocity_mps) / velocity_mps.norm();
  return out_m >= std::max(towards_m, 0.0);
}

}  // namespace

UncontrolledBodies::UncontrolledBodies(std::span<const UncontrolledBody> bodies, const Trajectory* stop,
                                       Time start)
    : bodies_(bodies), stop_(stop) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    stop_excess_m_[i] = excess_distance_m(*stop_, start, bodies_[i]);
}

bool UncontrolledBodies::allow(const Trajectory& candidate, double min_separation_m,
                               double deceleration_mps2) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const UncontrolledBody& body = bodies_[i];
    if (!rests_safely(candidate.rest_position_m(), stop_->rest_position_m(), body)) return false;
    if (is_passively_safe(candidate, body.reach, min_separation_m)) continue;
    if (stop_excess_m_[i] >= 0) return false;
    const double min_spare_m = std::min(stop_excess_m_[i] + kMinGain_m, 0.0);
    if (!avoids_by_driving_on(candidate, body, min_spare_m, deceleration_mps2)) return false;
  }
  return true;
}

}  // namespace sidestep
