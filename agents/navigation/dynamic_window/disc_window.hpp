// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/collision_times.hpp"
#include "agents/navigation/dynamic_window/disc_cell_times.hpp"
#include "agents/navigation/dynamic_window/objectives.hpp"
#include "common/motion/limits.hpp"

namespace sidestep {

struct DiscWindowSettings {
  double cell_m = 0.04;  ///< cell size of the table
  CollisionMethod method = CollisionMethod::kUniformTable;
  ObjectiveWeights weights{};
};

/// The input of DiscWindow::choose(), relative to the robot's position.
struct DiscWindowQuery {
  std::span<const Vec2> points_m{};  ///< obstacle points; points that are not finite are skipped
  Vec2 velocity_mps{0, 0};           ///< current velocity
  Vec2 goal_m{0, 0};
  double cycle_s = 1.0 / 60;  ///< time until the next decision
  /// Velocities that can be reached in this time are considered; default: the cycle.
  std::optional<double> window_s{};
};

/// An admissible velocity: if it is held for a cycle, the robot can still stop before it touches a point.
struct RatedVelocity {
  Vec2 velocity_mps{0, 0};
  float time_to_collision_s = 0;  ///< never later than the exact time; at most the horizon
  Objectives objectives{};
  float value = 0;  ///< the weighted sum of the objectives
};

struct DiscWindowChoice {
  std::vector<RatedVelocity> admissible;  ///< sorted by value, best first; empty: the robot must brake
  bool is_touching = false;               ///< a point lies within the disc
};

/// The dynamic window of an omnidirectional disc, whose motions are straight. Its admissible velocities can
/// be desired motions for a safety search. Considers the velocities of a grid that the robot's accelerations
/// reach within a cycle (see is_admissible) or, if the grid is too coarse for that, the velocities next to
/// the current velocity. Otherwise it works like DynamicWindow, except that the heading objective rates the
/// direction of the velocity, and the speed objective prefers the speed at which the robot can just stop at
/// its goal. Does not allocate once warm.
class DiscWindow {
 public:
  /// Throws std::invalid_argument if a dimension, limit or setting is invalid.
  DiscWindow(double radius_m, const MotionLimits& limits, const DiscWindowSettings& settings = {});

  /// The result belongs to this object and is valid until the next call. Throws std::invalid_argument if the
  /// velocity, goal, cycle or window is not finite, or the cycle is not positive.
  const DiscWindowChoice& choose(const DiscWindowQuery& query);

  /// The look-up table; nullopt with the exact method.
  const std::optional<CollisionTable>& table() const { return times_.table(); }

 private:
  struct Outline {
    double radius_m;
    std::vector<Vec2> velocities_mps;  // indexed by slot

    bool touches(const Vec2& point_m) const { return point_m.norm() <= radius_m; }
    double time_to_collision_s(const Vec2& point_m, std::size_t slot) const {
      return disc_time_to_collision_s(point_m, radius_m, velocities_mps[slot]);
    }
  };

  void prepare(double cycle_s);
  GridWindow window_around(const Vec2& velocity_mps, double window_s) const;
  /// Fills reachable_ with the velocities of a window that the robot's accelerations reach within a time; if
  /// there are none, with all velocities of the window.
  void find_reachable(const GridWindow& window, const Vec2& velocity_mps, double window_s);
  bool is_reachable(std::size_t slot, const Vec2& velocity_mps, double window_s) const;
  Objectives rate(std::size_t slot, const Vec2& goal_m) const;

  MotionLimits limits_;
  DiscWindowSettings settings_;
  CollisionTimes<Outline> times_;
  double cycle_s_ = 0;  // cycle that needed_s_ was computed for
  VelocityTimes needed_s_{};
  std::vector<std::size_t> reachable_;  // slots
  DiscWindowChoice choice_;
};

}  // namespace sidestep
