// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/trajectory.hpp"

namespace sidestep {

/// How far below the true clearance the computed one may lie; it never lies above.
inline constexpr double kClearanceTolerance_m = 1e-9;

/// THE clearance of two robots: the smallest distance between their two trajectories, both taken at the same
/// time, over all time from the later of the two starts on, less `min_separation_m` (both radii and the margin).
/// Negative: they come too near. Before the later start at least one of the two robots does something else
/// than its trajectory says, and that has to be checked with the version that says it.
///
/// The relative motion is piecewise quadratic, so the squared distance is a quartic on each piece; its minima
/// are bracketed between the extrema of its derivative, which finds all of them.
double clearance_m(const Trajectory& a, const Trajectory& b, double min_separation_m);

/// clearance_m(a, b, min_separation_m) >= 0, faster: it looks closely only where the two can come near.
bool is_clear(const Trajectory& a, const Trajectory& b, double min_separation_m);

/// The clearance of a trajectory from a disc that never moves.
double clearance_m(const Trajectory& a, const Vec2& centre_m, double min_separation_m);
bool is_clear(const Trajectory& a, const Vec2& centre_m, double min_separation_m);

}  // namespace sidestep
