// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "common/collision/obstacle_world.hpp"

namespace sidestep {

/// The properties of the floor and of the robots that a search needs.
struct GiveWayFloor {
  Field field;
  double radius_m;
  double required_m;        ///< required distance of the robot's centre from obstacles
  double min_separation_m;  ///< required distance between the centres of two robots
};

/// The input of a search.
struct GiveWayQuery {
  Vec2 position_m{0, 0};
  /// Trips of the robots with the right of way: start and destination.
  std::vector<std::pair<Vec2, Vec2>> trips;
  std::vector<Vec2> others_m;  ///< positions of all other robots
  /// Path along which the robot is already giving way; empty: it needs a place.
  std::vector<Vec2> way;
  double range_m = 1;                 ///< maximum distance of places from the robot
  std::vector<Vec2> unreachable_m{};  ///< places near these are not considered
  /// Positions among `others_m` that the way to a place may cross, because these robots can be asked to
  /// leave.
  std::vector<Vec2> passable_m{};
  Vec2 left_m{0, 0};  ///< where the robot was when it began to give way, if `way` is not empty
  /// Trips of idle robots that come back to where they were. The place that the robot left has to be off
  /// their routes before it comes back itself.
  std::vector<std::pair<Vec2, Vec2>> returns{};
  /// Only places are considered from which a way leads here once the others rest at `ends_m`; nullopt: all
  /// places are considered.
  std::optional<Vec2> home_m{};
  std::vector<Vec2> ends_m{};  ///< where the robots with the right of way will rest
};

/// Determines whether a robot is in the way of others that cannot drive around it. If so, finds the nearest
/// place off their routes that the robot can reach. The search is divided into steps, each of which plans at
/// most one path and examines a limited number of places, to fit into a control cycle.
class GiveWaySearch {
 public:
  /// Spacing of the examined places, as a fraction of the robot's radius.
  static constexpr double kGridFraction = 0.5;
  static constexpr int kMaxPlaces = 500;  ///< maximum number of places that one step examines

  explicit GiveWaySearch(const GiveWayFloor& floor);

  /// Starts a search and discards the previous search. `fixed`: all obstacles except robots.
  void begin(GiveWayQuery query, ObstacleWorld fixed);
  void cancel() { stage_ = Stage::kIdle; }
  bool is_active() const { return stage_ != Stage::kIdle; }
  /// Precondition: is_active().
  void step(Rng& rng);

  /// A robot at a position, as an obstacle.
  Circle disc_at(const Vec2& position_m) const;

  // Results, available once no search is active.
  /// Whether the robot at its position blocks another robot that cannot drive around it and all other robots.
  /// If the robot already gives way: whether it would block another robot anywhere along `way`.
  bool is_in_the_way() const { return is_in_the_way_; }
  /// If the robot already gives way: whether the end of `way` is on the route of another robot.
  bool is_place_on_route() const { return is_place_on_route_; }
  /// The path to the place; empty if no place is needed or no place was found.
  const std::vector<Vec2>& way() const { return way_; }

 private:
  enum class Stage { kIdle, kRoutes, kPassages, kPlaces };
  using Way = std::vector<Vec2>;

  void plan_route(Rng& rng);
  void check_passage(Rng& rng);
  void begin_places();
  void search_places(Rng& rng);
  /// Accepts a place if a path to it is worth planning: the place is free, off the routes, and not next to a
  /// place that was accepted before. Returns whether it accepts the place.
  bool take_candidate(const Vec2& place);
  /// Examines further places, up to the limit of a step. Returns the nearest place that remains; nullopt if
  /// it is not known yet or no place is left.
  std::optional<Vec2> next_place();
  /// The next place of the grid, in square rings around the robot; nullopt if all have been examined.
  std::optional<Vec2> next_of_grid();
  std::optional<Way> path(const ObstacleWorld& world, const Vec2& from_m, const Vec2& to_m, Rng& rng) const;

  GiveWayFloor floor_;
  NamedPlanner planner_;
  Stage stage_ = Stage::kIdle;
  GiveWayQuery query_;
  ObstacleWorld fixed_;
  ObstacleWorld afterwards_;  // the fixed obstacles, and the others where they will rest
  std::vector<Way> routes_;   // routes of the robots with the right of way
  std::size_t next_ = 0;      // index of the next trip or route
  bool is_in_the_way_ = false, is_place_on_route_ = false;
  Way way_;
  Way found_;  // a path to a place from which the way back has to be checked
  // The accepted places, as a heap with the nearest place on top.
  std::vector<std::pair<double, Vec2>> candidates_;
  std::set<std::pair<long, long>> taken_;
  std::vector<Vec2> unreachable_, without_return_;
  int ring_ = 0, index_ = 0, rings_ = 0;
};

}  // namespace sidestep
