// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "deploy/audit/metrics/report.hpp"
#include "tests/study/buildings/random_trips.hpp"

namespace sidestep {

struct BuildingResult {
  TripCounts trips;
  std::uint64_t contacts = 0, crashes = 0, crashes_in_motion = 0;
  double distance_m = 0;  ///< total over all robots
  std::uint64_t route_changes = 0;
  double plan_p99_us = 0, plan_max_us = 0;  ///< processor time of one decision
  double missed_percent = 0;                ///< percentage of the agents' cycles that were missed
  bool audit_passed = false;                ///< the audit passed and no process died

  /// Whether all goals were reached or reported as blocked, nothing was touched by a moving robot, and the
  /// audit passed.
  bool is_good() const { return trips.stuck == 0 && contacts == 0 && crashes_in_motion == 0 && audit_passed; }
};

/// The result of a run, from its report, the counts of its trips and the distance driven.
[[nodiscard]] BuildingResult building_result(const Report& report, const TripCounts& trips,
                                             double distance_m);

/// Sends the robots of a scenario to random places for this much virtual time, and then runs until their
/// orders are over. The scenario's goals are used only as places.
[[nodiscard]] BuildingResult run_building(const Scenario& scenario, Duration duration, std::uint64_t seed);

}  // namespace sidestep
