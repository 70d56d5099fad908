// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// How far a robot may drive without being observed before three standard deviations of its position estimate
/// and four of its odometry, as independent errors, reach `drift_bound_m`. 0 means that the robot has to wait
/// for an observation.
[[nodiscard]] double max_dead_reckoning_m(const LocalisationUncertainty& uncertainty, double drift_bound_m);

}  // namespace sidestep
