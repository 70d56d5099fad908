// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// The maximum distance that a robot may drive without being observed. At this distance, three standard
/// deviations of its position estimate and four of its odometry, combined as independent errors, reach
/// `drift_bound_m`. 0 means that the robot must wait for an observation.
[[nodiscard]] double max_dead_reckoning_m(const LocalisationUncertainty& uncertainty, double drift_bound_m);

}  // namespace sidestep
