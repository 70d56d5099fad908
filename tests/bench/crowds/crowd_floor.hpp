// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/config/scenario.hpp"
#include "common/geometry/box.hpp"
#include "common/random/rng.hpp"

namespace sidestep {

/// The floor of a crowd scene while its obstacles and robots are placed. Draws everything random from one
/// generator, so the same seed gives the same scene.
class CrowdFloor {
 public:
  /// Minimum distance of random goals from their starts. Robots that hardly move would make the ratio of
  /// times meaningless.
  static constexpr double kMinTravel_m = 1;

  /// The generator must outlive this object.
  CrowdFloor(const Field& field, Rng& rng) : rng_(rng) { scenario_.field = field; }

  Rng& rng() { return rng_; }
  const Field& field() const { return scenario_.field; }
  /// The area in which a robot at rest lies within the field, with some clearance from its border.
  Box robot_area() const;

  void add_obstacle(Shape obstacle) { scenario_.obstacles.push_back(std::move(obstacle)); }
  /// Random places for robots at rest. A further robot can pass between any two of them, and between them and
  /// the obstacles that have been added. Throws std::runtime_error if the area is too crowded.
  std::vector<Vec2> random_places(std::size_t count, const Box& area);
  /// Such places as goals, one for each start and at least kMinTravel_m away from it.
  std::vector<Vec2> random_goals(const std::vector<Vec2>& starts_m, const Box& area);

  /// A robot that faces its goal.
  void add_robot(const Vec2& start_m, const Goal& goal, Team team);
  /// A robot for each start, with the goal at the same index. Precondition: as many goals as starts.
  void add_robots(const std::vector<Vec2>& starts_m, const std::vector<Vec2>& goals_m, Team team);

  /// The scene, with the robots' ids in random order.
  Scenario finish();

 private:
  bool has_room(const Vec2& place_m, const std::vector<Vec2>& others_m) const;
  /// A place with room; nullopt if none was found. `start_m`: the start of the robot whose goal this is.
  std::optional<Vec2> random_place(const std::vector<Vec2>& others_m, const Vec2* start_m, const Box& area);

  Rng& rng_;
  Scenario scenario_;
};

/// A uniformly distributed point of a box.
Vec2 random_point(const Box& box, Rng& rng);

}  // namespace sidestep
