// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/geometry/circle.hpp"
#include "common/motion/floor_rules.hpp"
#include "common/random/rng.hpp"
#include "tests/bench/crowds/velocity_obstacle.hpp"

namespace sidestep {

/// Settings of optimal reciprocal collision avoidance.
struct ReciprocalSettings {
  std::string name{};
  double time_horizon_s = 0.5;      ///< time for which velocities are free of collisions with robots
  double obstacle_horizon_s = 0.3;  ///< time for which they are free of collisions with obstacles
  double neighbour_distance_m = 3;  ///< robots farther away are ignored
  double extra_radius_m = 0.007;    ///< added to the radius of each robot
  double noise_mps = 0.001;         ///< largest random change of preferred velocities, against symmetric jams
  /// Whether the velocities to choose from are those that the robot can reach within one cycle. If not, they
  /// are all velocities up to the speed limit, and the robot accelerates towards the chosen one.
  bool chooses_reachable = true;
};

/// A robot at the time of a choice.
struct ReciprocalRobot {
  Vec2 position_m{0, 0}, velocity_mps{0, 0};
  Vec2 preferred_mps{0, 0};
  double max_speed_mps = 0;
};

/// Optimal reciprocal collision avoidance (van den Berg, Guy, Lin, Manocha: Reciprocal n-body collision
/// avoidance, 2011). Each robot takes half of the responsibility for avoiding each other robot, and the full
/// responsibility for avoiding obstacles and the edges of the field.
class ReciprocalAvoidance {
 public:
  /// The map of the rules, if any, is ignored: pass its boxes as obstacles. Throws std::invalid_argument for
  /// invalid obstacles, and for settings that are negative, or not finite, or horizons and a cycle of zero.
  ReciprocalAvoidance(const FloorRules& rules, double cycle_s, ReciprocalSettings settings);

  /// Chooses the next velocities of all robots from the same knowledge: `velocities_mps[i]` is that of robot
  /// i. Robots ignore their limits of acceleration unless the settings say otherwise.
  void choose(std::span<const ReciprocalRobot> robots, Rng& rng, std::vector<Vec2>& velocities_mps);

 private:
  /// An obstacle as its corners, counter-clockwise, inflated by a radius.
  struct Obstacle {
    std::vector<Vec2> corners_m;
    double radius_m;
    Box bounds_m;
  };

  Vec2 choose_for(std::size_t robot, std::span<const ReciprocalRobot> robots, Rng& rng);
  /// Adds a polygon around the velocities that the robot can reach within a cycle.
  void add_reachable(const ReciprocalRobot& robot);
  void add_edges(const ReciprocalRobot& robot);
  void add_obstacles(const ReciprocalRobot& robot);
  void add_neighbours(std::size_t robot, std::span<const ReciprocalRobot> robots);
  void add_neighbour(const ReciprocalRobot& robot, const ReciprocalRobot& other);

  FloorRules rules_;
  double cycle_s_;
  ReciprocalSettings settings_;
  std::vector<Obstacle> obstacles_;
  std::vector<std::size_t> by_x_;      // all robots, by ascending x
  std::vector<std::size_t> place_of_;  // indexed by robot: place in by_x_
  std::vector<Vec2> corners_m_;        // corners of one obstacle, relative to the robot
  std::vector<HalfPlane> planes_;      // permitted velocities of one robot
};

}  // namespace sidestep
