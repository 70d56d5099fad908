// SPDX-License-Identifier: Apache-2.0
#include "common/messaging/observation_codec.hpp"

#include <cmath>

#include "common/messaging/version_codec.hpp"

namespace sidestep {
namespace {

constexpr double kMaxPositionVariance_m2 = 10;

std::optional<RobotObservation> checked(const RobotObservation& observation, Time now) {
  // The comparisons are false for NaN.
  const bool is_valid = observation.robot < kMaxRobots && is_plausible(observation.observed_at, now) &&
                        std::abs(observation.position_m.x()) <= kMaxCoordinate_m &&
                        std::abs(observation.position_m.y()) <= kMaxCoordinate_m &&
                        observation.velocity_mps.norm() <= kMaxSpeed_mps &&
                        observation.position_variance_m2 >= 0 &&
                        observation.position_variance_m2 <= kMaxPositionVariance_m2;
  return is_valid ? std::optional(observation) : std::nullopt;
}

}  // namespace

std::optional<RobotObservation> decode(const msg::TrackedRobot& message, Time now) {
  return checked({message.robot(),
                  time_from_ns(message.observed_at_ns()),
                  {message.observed_x_m(), message.observed_y_m()},
                  {message.vx_mps(), message.vy_mps()},
                  message.position_variance_m2()},
                 now);
}

std::optional<RobotObservation> decode(const msg::RobotNotice& message, Time now) {
  return checked({message.robot(),
                  time_from_ns(message.observed_at_ns()),
                  {message.x_m(), message.y_m()},
                  {message.vx_mps(), message.vy_mps()},
                  message.position_variance_m2()},
                 now);
}

void encode(const RobotObservation& observation, msg::RobotNotice& message) {
  constexpr double kBelowMaxSpeed_mps = kMaxSpeed_mps * (1 - 1e-9);  // also after rounding
  const double speed_mps = observation.velocity_mps.norm();
  const Vec2 velocity_mps = speed_mps > kBelowMaxSpeed_mps
                                ? Vec2(observation.velocity_mps * (kBelowMaxSpeed_mps / speed_mps))
                                : observation.velocity_mps;
  message.robot(observation.robot);
  message.observed_at_ns(to_ns(observation.observed_at));
  message.x_m(observation.position_m.x());
  message.y_m(observation.position_m.y());
  message.vx_mps(velocity_mps.x());
  message.vy_mps(velocity_mps.y());
  message.position_variance_m2(observation.position_variance_m2);
}

}  // namespace sidestep
