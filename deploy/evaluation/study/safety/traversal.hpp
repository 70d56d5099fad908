// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/config/scenario.hpp"
#include "deploy/evaluation/study/safety/interpenetration.hpp"

namespace sidestep {

/// What robots measure in this study.
inline constexpr double kStudyRadius_m = 0.09;

/// Two groups of robots that traverse the field from left to right and back, over and over (Bruce, ch. 5).
struct TraversalSettings {
  int robots = 8;
  double margin_m = 0.01;
  double position_noise_m = 0.0005;  ///< of vision, standard deviation per axis
  bool has_poor_odometry = false;    ///< ten times the noise and the scale error: fixes matter
  bool breaks_off = true;            ///< robots beyond their tracking bound brake; else there is no bound
};

/// Each robot has a place of its own at either side, drawn from the seed. The margin may be below the safety
/// budget, which scenario files may not have. The bodies are smaller than kStudyRadius_m and the margin so
/// much larger: robots keep the same distance, and the simulator does not push apart what is in one place.
Scenario traversal_scenario(const TraversalSettings& settings, std::uint64_t seed);

struct TraversalResult {
  std::uint64_t traversals = 0;  ///< completed by all robots together
  std::uint64_t contacts = 0;    ///< pairs that began to touch
  double penetration_m_s = 0;    ///< interpenetration depth x time
  double min_clearance_m = 1;
  double reference_error_m = 0;  ///< largest of a body against its reference
};

TraversalResult result_of(const Interpenetration& meter);

/// The whole system for so long after the coordinator first granted. Throws std::runtime_error if it never
/// does.
TraversalResult traverse_with_search(const Scenario& scenario, std::uint64_t seed, double seconds);

/// The same bodies, firmware and motion control, but every robot follows its own wish and nobody asks
/// anybody. There is no noise.
TraversalResult traverse_without_search(const Scenario& scenario, double seconds);

}  // namespace sidestep
