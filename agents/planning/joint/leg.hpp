// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/limits.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The durations of acceleration, cruising and braking in a straight motion from rest to rest.
struct LegTimes {
  Duration accelerate{0}, cruise{0}, brake{0};
  Duration total() const { return accelerate + cruise + brake; }
};

/// The shortest times for a distance (trapezoidal speed profile), rounded up to whole nanoseconds so that the
/// motion obeys the limits; zero for no distance. Preconditions: the distance is not negative, the limits are
/// positive.
[[nodiscard]] LegTimes leg_times(double distance_m, const MotionLimits& limits);

/// The straight motion that starts at `start` and takes these times. It obeys the limits if the times were
/// computed for this distance or a longer distance.
[[nodiscard]] Trajectory make_leg(Time start, const Vec2& from_m, const Vec2& to_m, const LegTimes& times);

/// The part of a trajectory from `from` to `until`, where it stops abruptly. The clearance of two
/// trajectories clipped to the same interval is therefore their clearance within that interval. Precondition:
/// from <= until.
[[nodiscard]] Trajectory clipped(const Trajectory& trajectory, Time from, Time until);

}  // namespace sidestep
