// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "common/collision/obstacle_world.hpp"

namespace sidestep {

/// What a robot needs to know of the floor to give way on it.
struct GiveWayFloor {
  Field field;
  double radius_m;
  double required_m;        ///< distance of the robot's centre from obstacles
  double min_separation_m;  ///< distance of the centres of two robots
};

struct GiveWaySearchSettings {
  double clearance_m = 0.02;   ///< beyond the minimum separation, from the routes of others
  double grid_fraction = 0.5;  ///< spacing of the places, as a part of the robot's radius
  std::size_t max_plans = 12;  ///< paths to places that are planned in one search
  int max_places = 500;        ///< that one step examines
};

/// What to find out.
struct GiveWayQuery {
  Vec2 position_m{0, 0};
  std::vector<std::pair<Vec2, Vec2>> trips;  ///< of the robots with the right of way: from where to where
  std::vector<Vec2> others_m;                ///< where all other robots are
  std::vector<Vec2> way;              ///< along which the robot already gives way; empty: it does not yet
  double range_m = 1;                 ///< how far away places may be
  std::vector<Vec2> unreachable_m{};  ///< no places near these
};

/// Finds out whether a robot is in the way of others that cannot drive around it, and if so, the nearest
/// place off their routes that it can reach. The search is divided into steps, each of which plans at most
/// one path and examines a limited number of places, so that a control cycle has time for it.
class GiveWaySearch {
 public:
  explicit GiveWaySearch(const GiveWayFloor& floor, const GiveWaySearchSettings& settings = {});

  /// Begins a search, and ends the last one. `fixed`: all obstacles but robots.
  void begin(GiveWayQuery query, ObstacleWorld fixed);
  void cancel() { stage_ = Stage::kIdle; }
  bool is_active() const { return stage_ != Stage::kIdle; }
  /// Precondition: is_active().
  void step(Rng& rng);

  // Results, once a search is not active any more.
  /// Whether the robot at its position is in the way of another one that cannot drive around it and all
  /// others or, if it already gives way, whether it would be in the way of another one anywhere along its
  /// way.
  bool is_in_the_way() const { return is_in_the_way_; }
  /// The way to the place; empty if it is not needed, or if there is no such place.
  const std::vector<Vec2>& way() const { return way_; }

 private:
  enum class Stage { kIdle, kRoutes, kPassages, kPlaces };
  using Way = std::vector<Vec2>;

  void plan_route(Rng& rng);
  void check_passage(Rng& rng);
  void begin_places();
  void search_places(Rng& rng);
  /// Whether it is worth a path: free, off the routes, and none is known next to it.
  bool is_candidate(const Vec2& place);
  /// Examines the next places, up to the limit of a step. Returns the nearest one that is left; nullopt: not
  /// known yet, or there is none any more.
  std::optional<Vec2> next_place();
  /// The next place of the grid, in square rings around the robot; nullopt: all are examined.
  std::optional<Vec2> next_of_grid();
  std::optional<Way> path(const Vec2& from_m, const Vec2& to_m, Rng& rng) const;
  /// A robot, as an obstacle.
  Circle disc_at(const Vec2& position_m) const;

  GiveWayFloor floor_;
  GiveWaySearchSettings settings_;
  NamedPlanner planner_;
  Stage stage_ = Stage::kIdle;
  GiveWayQuery query_;
  ObstacleWorld fixed_;
  std::vector<Way> routes_;  // of the robots with the right of way
  std::size_t next_ = 0;     // trip or route
  bool is_in_the_way_ = false;
  Way way_;
  // Places: those that are known to be free, by distance, and what has been examined.
  std::vector<std::pair<double, Vec2>> candidates_;
  std::set<std::pair<long, long>> taken_;
  std::vector<Vec2> unreachable_;
  int ring_ = 0, index_ = 0, rings_ = 0;
};

}  // namespace sidestep
