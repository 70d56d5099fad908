// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "common/config/scenario.hpp"
#include "tests/bench/crowds/crowd_result.hpp"
#include "tests/bench/crowds/reciprocal_avoidance.hpp"

namespace sidestep {

/// The five settings of which the benchmark takes the best for each family.
[[nodiscard]] std::span<const ReciprocalSettings> reciprocal_settings();

/// Drives the robots of a scene by optimal reciprocal collision avoidance until all have arrived, or until
/// the scenario's time limit. Each robot follows the shortest route around obstacles, and knows the positions
/// and velocities of all others without error or delay. Its acceleration is constant during a control cycle,
/// and limited like that of a Sidestep robot. Arrival is judged as by RunMetrics. Robots without a goal want
/// to stay at their starts. Robots that touch do not push each other.
///
/// `violations` counts how often a robot leaves the field. The processor time includes the planning of the
/// routes. Throws std::invalid_argument for scenarios with opponents or with robots off the floor.
[[nodiscard]] CrowdResult run_reciprocal_avoidance(const Scenario& scenario,
                                                   const ReciprocalSettings& settings, std::uint64_t seed);

}  // namespace sidestep
