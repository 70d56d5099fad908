// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "agents/planning/named_planner.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"

namespace sidestep {

struct GiveWaySettings {
  Duration stuck_after{1'500'000'000};  ///< without progress, a robot may be in the way of another one
  double progress_m = 0.1;              ///< motion that counts as progress
  Duration retry_after{500'000'000};    ///< between two searches, and two checks whether the way is free
  Duration give_up_after{20'000'000'000};
  Duration max_pause{1'000'000'000};  ///< after a longer time without decisions, progress is judged anew
  double clearance_m = 0.02;          ///< beyond the minimum separation, from the routes of others
  double first_range_m = 1;  ///< places up to this distance are searched at first, later twice as far
  double longest_range_m = 8;
  double grid_fraction = 0.5;  ///< spacing of the places, as a part of the robot's radius
  std::size_t max_plans = 12;  ///< paths that are planned in one search
};

/// Another robot, and the places to which it may want to go.
struct OtherRobot {
  RobotId id = 0;
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
  /// A robot's centre keeps `required_m` from obstacles; robots' centres stay `min_separation_m` apart.
  GiveWay(const Field& field, double radius_m, double required_m, double min_separation_m,
          const GiveWaySettings& settings = {});

  /// Whether update() is to be called: the robot has made no progress for long, or may stop giving way. Call
  /// it once per decision, with the robot's position.
  [[nodiscard]] bool is_due(Time now, const Vec2& position_m);
  /// Decides whether to give way. `fixed`: all obstacles but robots. Precondition: is_due().
  void update(Time now, const Vec2& position_m, std::span<const OtherRobot> others, ObstacleWorld fixed,
              Rng& rng);
  /// Where the robot should go instead of its goal; nullopt: to its goal.
  std::optional<Vec2> place_m() const { return way_.empty() ? std::nullopt : std::optional(way_.back()); }
  /// Forgets the place: the robot has another goal.
  void restart(Time now);

 private:
  using Way = std::vector<Vec2>;
  struct Scene {
    ObstacleWorld fixed;
    Rng* rng;
    std::vector<Way> routes;  // of the robots with the right of way
  };
  /// A robot, as an obstacle.
  Circle disc_at(const Vec2& position_m) const {
    return {position_m, std::max(0.0, min_separation_m_ - required_m_)};
  }
  /// Whether one of the routes leads through the robot, and there is no way around it.
  bool blocks_a_passage(Scene& scene, const Vec2& position_m) const;
  void find_routes(Scene& scene, std::span<const OtherRobot> others) const;
  /// Empty if there is no such place.
  std::vector<Vec2> find_way(Scene& scene, const Vec2& position_m, std::span<const OtherRobot> others) const;
  std::vector<Vec2> places_near(const Scene& scene, const Vec2& position_m) const;
  std::optional<std::vector<Vec2>> path(const Scene& scene, const Vec2& from_m, const Vec2& to_m) const;

  Field field_;
  double radius_m_, required_m_, min_separation_m_;
  GiveWaySettings settings_;
  NamedPlanner planner_;
  Vec2 anchor_m_{0, 0};  // where the robot has been since anchored_at_
  Time anchored_at_{}, checked_at_{}, began_at_{};
  Time called_at_{};
  double range_m_;
  std::vector<RobotId> yields_to_;  // they keep the right of way until they have passed
  std::vector<Vec2> way_;           // from the place that the robot left to the one where it gives way
};

}  // namespace sidestep
