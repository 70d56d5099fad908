// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "common/collision/shapes.hpp"
#include "common/map/floor_map.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The computed clearance is never above the true one, and at most this far below it.
inline constexpr double kClearanceTolerance_m = 1e-9;

/// The clearance between two robots; this is the only such function in the system. It is the minimum distance
/// between their trajectories at equal times, from the later start on, minus `min_separation_m` (both radii
/// and the margin). Negative if the robots come too close. Before the later start, at least one robot
/// executes another version, which has to be checked separately.
///
/// The relative motion is piecewise quadratic, so the squared distance is a quartic on each piece. Its minima
/// are bracketed by the extrema of its derivative, which finds all of them.
double clearance_m(const Trajectory& a, const Trajectory& b, double min_separation_m);

/// Whether clearance_m(a, b, min_separation_m) >= 0; faster, because it examines only the pieces on which the
/// robots can come close.
[[nodiscard]] bool is_clear(const Trajectory& a, const Trajectory& b, double min_separation_m);

/// The clearance between a trajectory and a static disc.
double clearance_m(const Trajectory& a, const Vec2& centre_m, double min_separation_m);
[[nodiscard]] bool is_clear(const Trajectory& a, const Vec2& centre_m, double min_separation_m);

/// The clearance between a trajectory and a static shape: the minimum distance to its boundary, minus
/// `min_separation_m`. It is minus infinity if the trajectory enters a shape other than a circle; inside a
/// circle it is finite.
double clearance_m(const Trajectory& a, const Shape& shape, double min_separation_m);
/// Whether clearance_m(a, shape, min_separation_m) >= 0.
[[nodiscard]] bool is_clear(const Trajectory& a, const Shape& shape, double min_separation_m);

/// Whether the trajectory keeps a clearance of at least `min_separation_m` from all blocked cells of a map
/// and from the outside. The time grows with the length of the path.
[[nodiscard]] bool is_clear(const Trajectory& a, const FloorMap& map, double min_separation_m);

/// Calls `call` with boxes of blocked cells, or of the outside, to which the trajectory comes closer than
/// `min_separation_m`. Together they cover all such cells. Stops when `call` returns false, and then returns
/// false.
bool for_each_near_box(const Trajectory& a, const FloorMap& map, double min_separation_m,
                       const std::function<bool(const Box&)>& call);

}  // namespace sidestep
