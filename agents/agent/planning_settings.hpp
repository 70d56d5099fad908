// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "common/time/time.hpp"

namespace sidestep {

/// Tuning of an agent's planning. Safety does not depend on these values.
struct PlanningSettings {
  // Range of other robots' versions that are considered.
  double max_speed_hold_s = 0.15;  ///< how long a robot may hold maximum speed before braking
  double max_page_age_s = 0.1;     ///< maximum age of a ledger page at search time

  // Routes around static obstacles, stationary robots and moving obstacles.
  double extra_clearance_m = 0.03;         ///< preferred clearance beyond the required one
  Duration stationary_after{500'000'000};  ///< a robot at rest for longer counts as an obstacle
  Duration max_route_age{200'000'000};     ///< a free route is kept this long after obstacles have changed
  std::size_t max_stationary = 8;          ///< number of nearest stationary robots considered
  std::size_t max_moving = 4;              ///< number of nearest moving obstacles considered
  double moving_range_m = 1.5;             ///< moving obstacles farther away are ignored
  double moving_grid_m = 0.05;  ///< grid of their positions and radii: avoids replanning in every cycle
  Duration moving_horizon{150'000'000};  ///< their motion over this time is added to their radii

  /// An acceleration is held for at least this long, also if cycles are shorter. Motors take some 10 ms to
  /// reach one: robots would leave versions that soon brake again.
  Duration min_hold{16'000'000};

  // Goals.
  double at_goal_m = 0.001;             ///< a robot whose version ends this close to its goal stays there
  double neighbour_at_goal_m = 0.02;    ///< a neighbour at rest this close to its goal is assumed to stay
  Duration blocked_after{300'000'000};  ///< a goal that cannot be reached for longer is reported as blocked

  // Observation.
  /// A robot stops if vision has not observed it, or its agent has had no list of obstacles, for longer.
  Duration max_fix_age{300'000'000};

  /// A robot stops if the coordinator has compared no robots with their versions for longer.
  Duration max_watch_age{600'000'000};

  // Sight by the robot's own laser.
  std::array<double, 4> clearances_in_sight_m{0.35, 0.2, 0.1, 0.03};  ///< instead of extra_clearance_m
  double max_heading_error_rad = 0.02;     ///< bound of the error of a scan's heading
  double creep_mps = 0.03;                 ///< a robot that is not faster counts as being at rest
  Duration occluded_after{3'000'000'000};  ///< a corner that stops the robot for longer is avoided ...
  double occluded_range_m = 0.4;           ///< ... if it has not come farther away meanwhile
  Duration occluded_corner_memory{20'000'000'000};  ///< ... for this long
  double corner_slack_m = 0.4;  ///< what stops the robot this near to a person or robot is no corner

  // Right of way, and deadlocks.
  Duration right_of_way_period{10'000'000'000};  ///< lower ids, then higher ids, have priority for this long
  // Where robots cannot pass each other, for the time to drive this far and a while:
  double passage_m = 40, passage_s = 10;
  double longest_trip_m = 20;           ///< of other robots; for longer ones, the next waypoint counts
  double standstill_mps = 0.01;         ///< intended speeds below this count as standing still
  double waiting_speed_fraction = 0.5;  ///< intended speeds below this fraction of the limit count as waiting
  double recovery_clear_path_m = 0.5;   ///< length of free path that a recovery direction requires
  double recovery_hold_s = 0.3;         ///< how long the velocity of a recovery is held
};

}  // namespace sidestep
