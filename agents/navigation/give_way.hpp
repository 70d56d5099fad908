// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "agents/navigation/give_way_search.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

struct GiveWaySettings {
  Duration give_up_after{20'000'000'000};  ///< a robot gives way for no longer than this
};

/// Another robot, and the places to which it may want to go.
struct OtherRobot {
  RobotId id = 0;
  bool is_near = true;  ///< if false, only the id is known
  Vec2 position_m{0, 0};
  std::array<std::optional<Vec2>, 2> goals_m{};
  bool has_right_of_way = false;
  bool is_held = false;         ///< it stays where it is
  bool returns = false;         ///< it has no order to drive, and comes back to where it was
  bool rests = false;           ///< it has been at rest for a moment
  bool waits = false;           ///< it stays, but leaves its place for a robot that has to get out
  std::optional<Vec2> end_m{};  ///< where it will rest; nullopt if it is going out of the way
};

/// Makes a robot back out of a passage in which robots cannot pass each other. This applies to a robot that
/// makes no progress and blocks the route of a robot that has the right of way and no way around it. The
/// blocking robot drives to the nearest reachable place off the routes of all robots with the right of way,
/// for example a bay, and stays there until they have passed. If it reaches no such place because robots that
/// wait stand in the way, it chooses one behind them. A robot that has to come back prefers places from which
/// the others will not lock it out. Safety does not depend on it.
class GiveWay {
 public:
  explicit GiveWay(const GiveWayFloor& floor, const GiveWaySettings& settings = {});

  /// Returns whether to search: the robot has made no progress for a long time, or may be able to stop giving
  /// way. Call it once per decision, with the length of the robot's route to its goal, or infinity if there
  /// is none. Robots that block each other move back and forth, which does not count as progress.
  [[nodiscard]] bool track_progress(Time now, double remaining_m);
  /// Whether a search has begun. If so, call search(). Otherwise call begin_search() if track_progress()
  /// returns true.
  bool is_searching() const { return search_.is_active(); }
  /// Starts a search. `others`: all robots nearby, and the robots in yields_to() that are still under way.
  /// `fixed`: all obstacles except robots. `home_m`: where the robot comes back to; nullopt: it does not.
  void begin_search(Time now, const Vec2& position_m, std::span<const OtherRobot> others, ObstacleWorld fixed,
                    const std::optional<Vec2>& home_m = std::nullopt);
  /// Performs one step of the search; the last step decides whether to give way. Precondition:
  /// is_searching().
  void search(Time now, Rng& rng);
  /// Whether the last step of the search has stopped giving way although the others have not passed.
  bool has_given_up() const { return has_given_up_; }
  /// The place where the robot should go instead of its goal; nullopt if it should go to its goal.
  std::optional<Vec2> place_m() const { return way_.empty() ? std::nullopt : std::optional(way_.back()); }
  /// The robots that must pass before the robot may leave its place. A robot that is still far away has not
  /// passed.
  std::span<const RobotId> yields_to() const { return yields_to_; }
  /// The first of these robots, and where it was when the robot began to give way or last looked; nullopt if
  /// the robot does not give way.
  std::optional<std::pair<RobotId, Vec2>> waits_for() const;
  /// Forgets the place, because the robot has another goal.
  void restart(Time now);

 private:
  using Trip = std::pair<Vec2, Vec2>;  // a start and a destination
  static constexpr double kInfinity_m = std::numeric_limits<double>::infinity();
  /// Looks for another place if a robot covers this one or if the robot comes no nearer to it.
  void check_place(Time now, const Vec2& position_m, std::span<const OtherRobot> others);
  void remember_trips(const OtherRobot& other);
  /// Makes the next search consider more places.
  void widen_search();
  /// Stops giving way if the others have passed or nobody passes for a long time. Otherwise determines
  /// whether they need the robot's place.
  void check_way(Time now);

  GiveWaySettings settings_;
  GiveWaySearch search_;
  double remaining_m_ = kInfinity_m;  // remaining length of the last route
  double shortest_m_ = kInfinity_m;   // minimum of remaining_m_ since the robot last blocked no other robot
  Time progress_at_{}, checked_at_{}, began_at_{};
  Time called_at_{};
  double range_m_;
  double min_separation_m_;
  std::vector<RobotId> searched_;       // robots with the right of way when the search began
  std::vector<RobotId> yields_to_;      // robots that keep the right of way until they have passed
  std::multimap<RobotId, Trip> trips_;  // last known trips of all robots that were near when a search began
  std::vector<Vec2> unreachable_;       // places that could not be reached
  int moves_ = 0;                       // number of times that others needed its place
  double nearest_m_ = kInfinity_m;      // smallest distance to the place so far
  Time nearer_at_{};
  bool has_given_up_ = false;
  bool has_waiting_ = false;     // whether others wait
  bool passes_waiting_ = false;  // whether the search ignores robots that wait
  bool comes_back_ = false;      // whether the robot has to come back
  bool is_to_return_ = true;     // whether the search considers only places with a way back
  std::vector<Vec2> way_;        // to the place where the robot gives way; empty: it does not give way
  bool is_replacing_ = false;    // whether the robot needs another place than that, and is looking for it
  Vec2 searched_from_m_{0, 0};   // where the robot was when the search began
  Vec2 left_m_{0, 0};            // where the robot was when it began to give way
};

}  // namespace sidestep
