// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/time/time.hpp"

namespace sidestep {

/// Tuning of an agent's planning. Safety does not depend on these values.
struct PlanningSettings {
  // Range within which other robots' versions are considered.
  double max_speed_hold_s = 0.15;  ///< longest time that a robot may hold maximum speed before braking
  double max_page_age_s = 0.1;     ///< maximum age of a ledger page at search time

  // Routes around static obstacles, stationary robots and moving obstacles.
  double extra_clearance_m = 0.03;         ///< preferred clearance in addition to the required one
  Duration stationary_after{500'000'000};  ///< a robot at rest for longer than this counts as an obstacle
  /// A free route is kept for this long after obstacles have changed.
  Duration max_route_age{200'000'000};
  std::size_t max_stationary = 8;  ///< number of stationary robots considered, the nearest ones first
  std::size_t max_moving = 4;      ///< number of moving obstacles considered, the nearest ones first
  double moving_range_m = 1.5;     ///< moving obstacles farther away are ignored
  /// Their positions and radii are rounded to this grid to avoid replanning in every cycle.
  double moving_grid_m = 0.05;
  Duration moving_horizon{150'000'000};  ///< radii are enlarged by their motion over this time

  /// Minimum time for which an acceleration is held, even if cycles are shorter. Motors take about 10 ms to
  /// reach an acceleration, so robots would deviate from versions that soon brake again.
  Duration min_hold{16'000'000};

  // Goals.
  double at_goal_m = 0.001;           ///< a robot whose version ends this close to its goal stays there
  double neighbour_at_goal_m = 0.02;  ///< a neighbour at rest this close to its goal is assumed to stay
  /// A goal that is unreachable for longer than this is reported as blocked.
  Duration blocked_after{300'000'000};

  // Supervision by vision and the coordinator.
  /// A robot stops if, for longer than this, vision has not observed it or its agent has received no list of
  /// obstacles.
  Duration max_fix_age{300'000'000};

  /// A robot stops if the coordinator has not compared any robots with their versions for longer than this.
  Duration max_watch_age{600'000'000};

  // Laser sight.
  std::array<double, 4> clearances_in_sight_m{0.35, 0.2, 0.1, 0.03};  ///< used instead of extra_clearance_m
  double max_heading_error_rad = 0.02;  ///< bound of the error of a scan's heading
  double creep_mps = 0.03;              ///< a slower robot counts as being at rest
  /// A corner that stops the robot for longer than this is avoided ...
  Duration occluded_after{3'000'000'000};
  double occluded_range_m = 0.4;                    ///< ... if the robot has not moved farther away meanwhile
  Duration occluded_corner_memory{20'000'000'000};  ///< ... for this long
  /// If a person or robot is this near, the robot's stop is not attributed to a corner.
  double corner_slack_m = 0.4;

  // Right of way, and deadlocks.
  Duration right_of_way_period{10'000'000'000};  ///< for this long lower ids have priority, then higher ids
  // Right of way where robots cannot pass each other: it lasts for the time to drive this far plus a fixed
  // time.
  double passage_m = 40, passage_s = 10;
  /// Trips of other robots; for longer ones, only the next waypoint counts.
  double longest_trip_m = 20;
  double standstill_mps = 0.01;         ///< intended speeds below this count as standing still
  double waiting_speed_fraction = 0.5;  ///< intended speeds below this fraction of the limit count as waiting
  double recovery_clear_path_m = 0.5;   ///< length of free path that a recovery direction requires
  double recovery_hold_s = 0.3;         ///< how long the velocity of a recovery is held
};

}  // namespace sidestep
