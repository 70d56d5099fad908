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
  Duration stuck_after{1'500'000'000};  ///< without progress, a robot may be in the way of another one
  double progress_m = 0.1;              ///< nearer to the goal than ever before counts as progress
  Duration retry_after{500'000'000};    ///< between two searches, and two checks whether the way is free
  Duration unreachable_after{3'000'000'000};  ///< a place to which the robot comes no nearer is given up
  Duration give_up_after{20'000'000'000};
  Duration max_pause{1'000'000'000};  ///< after a longer time without decisions, progress is judged anew
  double first_range_m = 1;  ///< places up to this distance are searched at first, later twice as far
  double longest_range_m = 8;
};

/// Another robot, and the places to which it may want to go.
struct OtherRobot {
  RobotId id = 0;
  bool is_near = true;  ///< otherwise, only the id is known
  Vec2 position_m{0, 0};
  std::array<std::optional<Vec2>, 2> goals_m{};
  bool has_right_of_way = false;
};

/// Lets a robot back out of a passage in which two robots cannot pass each other. A robot that makes no
/// progress, and stands on the route of one that has the right of way and no way around it, drives to the
/// nearest place that it can reach and that is off the routes of all such robots, for example a bay, and
/// stays there until the way back is not needed any more. Safety does not depend on it.
class GiveWay {
 public:
  explicit GiveWay(const GiveWayFloor& floor, const GiveWaySettings& settings = {});

  /// Whether to search: the robot has made no progress for long, or may stop giving way. Call it once per
  /// decision, with the length of the robot's route to its goal; infinity: there is none. Robots that block
  /// each other move to and fro, which is no progress.
  [[nodiscard]] bool is_due(Time now, double remaining_m);
  /// Whether search() is to be called, because a search has begun; otherwise begin_search(), if is_due().
  bool is_searching() const { return search_.is_active(); }
  /// `others`: all robots nearby, and those of yields_to() that are still on their way. `fixed`: all
  /// obstacles but robots.
  void begin_search(Time now, const Vec2& position_m, std::span<const OtherRobot> others,
                    ObstacleWorld fixed);
  /// One step of the search, which decides whether to give way in its last one. Precondition:
  /// is_searching().
  void search(Time now, Rng& rng);
  /// Where the robot should go instead of its goal; nullopt: to its goal.
  std::optional<Vec2> place_m() const { return way_.empty() ? std::nullopt : std::optional(way_.back()); }
  /// The robots that may pass before the robot gives up its place. They have not passed if they are far away.
  std::span<const RobotId> yields_to() const { return yields_to_; }
  /// Forgets the place: the robot has another goal.
  void restart(Time now);

 private:
  using Trip = std::pair<Vec2, Vec2>;  // from where to where
  static constexpr double kInfinity_m = std::numeric_limits<double>::infinity();
  /// Gives up the place if another robot covers it, or if the robot comes no nearer to it.
  void check_place(Time now, const Vec2& position_m, std::span<const OtherRobot> others);
  void remember_trips(const OtherRobot& other);

  GiveWaySettings settings_;
  GiveWaySearch search_;
  double remaining_m_ = kInfinity_m;  // of the last route
  double shortest_m_ = kInfinity_m;   // since the last search that found the robot in nobody's way
  Time progress_at_{}, checked_at_{}, began_at_{};
  Time called_at_{};
  double range_m_;
  double min_separation_m_;
  std::vector<RobotId> searched_;       // with the right of way when the search began
  std::vector<RobotId> yields_to_;      // they keep the right of way until they have passed
  std::multimap<RobotId, Trip> trips_;  // of all that were near when a search began, as they were last known
  std::vector<Vec2> unreachable_;       // places
  double nearest_m_ = kInfinity_m;      // to the place so far
  Time nearer_at_{};
  std::vector<Vec2> way_;  // from the place that the robot left to the one where it gives way
};

}  // namespace sidestep
