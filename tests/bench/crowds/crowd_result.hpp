// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace sidestep {

/// How one method drove the robots of one crowd scene.
struct CrowdResult {
  int robots = 0, arrived = 0;
  std::uint64_t contacts = 0;        ///< pairs of robots, or robots and obstacles, that touched
  std::uint64_t violations = 0;      ///< violations of the motion limits or of the protocol's audit
  std::optional<double> ratio;       ///< see straight_line_time_ratio(); nullopt if not all arrived
  std::optional<double> makespan_s;  ///< arrival of the last robot; nullopt if not all arrived
  double cpu_us = 0;                 ///< processor time that one robot spends on one control cycle, mean
};

}  // namespace sidestep
