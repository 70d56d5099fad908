// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/cell_times.hpp"
#include "agents/navigation/dynamic_window/differential_drive.hpp"
#include "common/geometry/convex_polygon.hpp"

namespace sidestep {

/// The exact times to collision of all cells that the hull can reach within the horizon, for all wheel speeds
/// of the velocity grid. Two convex shapes touch first at a corner of one of them. So the time of a cell is
/// the earlier of two times: when the cell's first corner enters the hull, and when the hull's first corner
/// enters the cell. Throws std::invalid_argument if the hull or the horizon is invalid, or the grid would be
/// too large.
[[nodiscard]] CellTimes hull_cell_times(const DifferentialDrive& drive, const ConvexPolygon& hull,
                                        double cell_m, double horizon_s);

}  // namespace sidestep
