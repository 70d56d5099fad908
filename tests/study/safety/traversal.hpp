// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "tests/study/safety/interpenetration.hpp"

namespace sidestep {

/// The robots' radius in this study.
inline constexpr double kStudyRadius_m = 0.09;

/// Two groups of robots that traverse the field from left to right and back repeatedly (Bruce 2006, chapter
/// 5).
struct TraversalSettings {
  int robots = 8;
  double margin_m = 0.014;
  double position_noise_m = 0.0005;  ///< standard deviation of vision, on each axis
  bool has_poor_odometry = false;    ///< tenfold noise and scale error, so that vision matters
  bool stops_off_reference = true;   ///< stops beyond the tracking bound; false: there is no bound
};

/// Creates the scenario. Each robot has its own slot on each side, assigned by the seed. Unlike in scenario
/// files, the margin may be below the safety budget. The bodies are smaller than kStudyRadius_m and the
/// margin is larger by the difference: robots keep the same separation, and the simulator does not resolve
/// contacts.
Scenario traversal_scenario(const TraversalSettings& settings, std::uint64_t seed);

struct TraversalResult {
  std::uint64_t traversals = 0;  ///< total over all robots
  std::uint64_t contacts = 0;    ///< number of times that a pair began to touch
  double penetration_m_s = 0;    ///< interpenetration depth integrated over time
  double min_clearance_m = 1;
  double reference_error_m = 0;  ///< largest distance between a body and its reference
};

TraversalResult result_of(const Interpenetration& meter);

/// Runs the whole system for `seconds` after the coordinator's first grant. Throws std::runtime_error if the
/// coordinator never grants.
TraversalResult traverse_with_search(const Scenario& scenario, std::uint64_t seed, double seconds);

/// Runs the same bodies, firmware and motion control without agents and coordinator: every robot executes its
/// desired acceleration unchecked, and there is no noise.
TraversalResult traverse_without_search(const Scenario& scenario, double seconds);

}  // namespace sidestep
