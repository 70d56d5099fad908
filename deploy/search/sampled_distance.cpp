// SPDX-License-Identifier: Apache-2.0
#include "deploy/search/sampled_distance.hpp"

#include <algorithm>

namespace sidestep {
namespace {

constexpr double kRounding_m = 1e-6;
constexpr double kLeastStep_s = 0.004;

/// The largest speed that a motion has: it is largest where a phase begins.
double top_speed_mps(const Trajectory& trajectory) {
  Vec2 velocity = trajectory.at_start().velocity_mps;
  double top = velocity.norm();
  for (const Phase& phase : trajectory.phases()) {
    velocity += to_seconds(phase.duration) * phase.acceleration_mps2;
    top = std::max(top, velocity.norm());
  }
  return top;
}

}  // namespace

bool come_nearer(const Trajectory& a, const Trajectory& b, double keep_m, Time from) {
  const Time to = std::max({a.end(), b.end(), from});
  const double closing_mps = top_speed_mps(a) + top_speed_mps(b);
  for (Time t = from;;) {
    const double room_m = (a.state_at(t).position_m - b.state_at(t).position_m).norm() - keep_m;
    if (room_m < -kRounding_m) return true;
    if (t >= to || closing_mps <= 0) return false;
    // For so long they cannot come nearer than they may.
    t = std::min(to, t + from_seconds(std::clamp(room_m / closing_mps, kLeastStep_s, 60.0)));
  }
}

}  // namespace sidestep
