// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "agents/navigation/dynamic_window/collision_times.hpp"
#include "agents/navigation/dynamic_window/differential_drive.hpp"
#include "agents/navigation/dynamic_window/drive_state.hpp"
#include "agents/navigation/dynamic_window/hull.hpp"
#include "agents/navigation/dynamic_window/objectives.hpp"

namespace sidestep {

struct DynamicWindowSettings {
  double padding_m = 0.02;  ///< distance that the hull should keep from points
  /// Collisions after this time are ignored. Velocities that need this long to brake are inadmissible.
  double horizon_s = 1;
  double cell_m = 0.03;  ///< cell size of the table
  CollisionMethod method = CollisionMethod::kUniformTable;
  ObjectiveWeights weights{};
};

/// The input of DynamicWindow::choose(), in the robot's frame.
struct WindowQuery {
  std::span<const Vec2> points_m{};  ///< obstacle points; points that are not finite are skipped
  WheelSpeeds wheels{};              ///< current speeds
  DriveGoal goal{};
  double cycle_s = 0.1;  ///< time until the next decision
  /// Speeds that can be reached in this time are considered; default: the cycle.
  std::optional<double> window_s{};
};

/// An admissible velocity: if it is held for a cycle, the robot can still stop on its arc before it touches a
/// point.
struct RatedWheelSpeeds {
  WheelSpeeds wheels;
  float time_to_collision_s = 0;  ///< never later than the exact time; at most the horizon
  Objectives objectives{};
  float value = 0;  ///< the weighted sum of the objectives
};

struct WindowChoice {
  DriveState state = DriveState::kTurn;
  std::vector<RatedWheelSpeeds> admissible;
  std::optional<std::size_t> best;  ///< index of the best admissible pair; nullopt: the robot must brake
  /// The best speeds; if there are none, the speeds after braking for a cycle.
  WheelSpeeds command;
  bool is_touching = false;  ///< a point lies within the padded hull
};

/// The dynamic window of a robot with two wheels and a convex hull (Fox, Burgard, Thrun 1997; Philippsen,
/// EPFL thesis 3146, ch. 3). Considers the wheel speeds of a grid that are reachable within a cycle. A pair
/// of speeds is admissible if the time to collision along its arc exceeds the braking time plus a cycle; the
/// best pair has the highest weighted sum of distance, heading and speed objectives. Does not allocate once
/// warm.
class DynamicWindow {
 public:
  /// Building the table takes seconds. Throws std::invalid_argument if a dimension, limit or setting
  /// is invalid.
  DynamicWindow(const DifferentialDrive& drive, const ConvexPolygon& hull,
                const DynamicWindowSettings& settings = {});

  /// The result belongs to this object and is valid until the next call. Throws std::invalid_argument if the
  /// wheel speeds, goal, cycle or window is not finite, or the cycle or the goal's radius is not positive.
  const WindowChoice& choose(const WindowQuery& query);

  /// The look-up table; nullopt with the exact method.
  const std::optional<CollisionTable>& table() const { return times_.table(); }

 private:
  struct Outline {
    Hull hull;
    std::vector<ArcMotion> motions;  // indexed by slot

    bool touches(const Vec2& point_m) const { return hull.contains(point_m); }
    double time_to_collision_s(const Vec2& point_m, std::size_t slot) const {
      return hull.time_to_collision_s(point_m, motions[slot]);
    }
  };
  /// The pose at which the robot comes to rest if it brakes after one cycle.
  struct Standstill {
    float x_m, y_m, cosine, sine;
  };

  void prepare(double cycle_s);
  GridWindow window_around(const WindowQuery& query) const;
  Objectives rate(std::size_t slot, const DriveGoal& goal) const;
  void add_admissible(const WindowQuery& query, const GridWindow& window);

  DifferentialDrive drive_;
  DynamicWindowSettings settings_;
  CollisionTimes<Outline> times_;
  double cycle_s_ = 0;  // cycle that needed_s_ and standstills_ were computed for
  VelocityTimes needed_s_{};
  std::vector<Standstill> standstills_;  // indexed by slot
  WindowChoice choice_;
};

}  // namespace sidestep
