// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agents/navigation/bubble_band/bubble_band.hpp"
#include "agents/navigation/dynamic_window/disc_window.hpp"
#include "agents/navigation/potential_field/potential_field.hpp"
#include "agents/planning/named_planner.hpp"
#include "common/collision/obstacle_world.hpp"
#include "common/motion/trajectory.hpp"

namespace sidestep {

/// The input of the local methods. Its spans and pointers are used only during the call.
struct LocalQuery {
  State at;
  std::span<const Vec2> path_m{};  ///< from the next waypoint to the end; not empty
  const ObstacleWorld* world = nullptr;
  std::span<const Circle> others{};  ///< bodies that the world does not contain
  double cycle_s = 1.0 / 60;
};

struct LocalChoice {
  Vec2 target_m{0, 0};  ///< the point to steer to
  /// The velocity chosen by the window or the field. nullopt if there is neither, if the robot is near the
  /// goal or too near to an obstacle, or if the chosen velocity makes no progress.
  std::optional<Vec2> velocity_mps{};
  std::span<const Vec2> preferred_mps{};  ///< the next best velocities; valid until the next call
};

/// Follows a planner's path with local methods: a band determines the point to steer to; a window or a
/// potential field determines the velocity. Safety does not depend on it. Does not allocate once warm.
class LocalDriver {
 public:
  /// The robot's centre keeps `separation_m` from the edges of obstacles and `radius_m` from the field's
  /// border. Throws std::invalid_argument if a distance or limit is invalid.
  LocalDriver(const LocalMethods& methods, const Field& field, double radius_m, double separation_m,
              const MotionLimits& limits);

  [[nodiscard]] LocalChoice choose(const LocalQuery& query);

  /// The band's bubbles. Empty without a band, and while the robot follows the path itself because no band
  /// fits through.
  std::span<const Bubble> bubbles() const;

 private:
  /// Distance from a position to the nearest obstacle, body or border; negative inside.
  double distance_m(const LocalQuery& query, const Vec2& at_m) const;
  bool is_line_free(const LocalQuery& query, const Vec2& to_m) const;
  void update_band(const LocalQuery& query);
  /// Whether the band still leads to a place that is far enough ahead on the path, without a long detour.
  bool fits_path(const LocalQuery& query) const;
  Vec2 target_m(const LocalQuery& query) const;
  /// Fills points_m_ with the first obstacle point on each ray, relative to the robot.
  void cast_rays(const LocalQuery& query);
  void choose_velocity(const LocalQuery& query, double length_m, LocalChoice& choice);
  void follow_force(const LocalQuery& query, LocalChoice& choice) const;

  LocalMethods methods_;
  Field field_;
  double radius_m_, separation_m_;
  BubbleBand band_;
  std::optional<DiscWindow> window_;
  PotentialField field_force_;
  double max_speed_mps_;
  std::vector<Vec2> path_m_, points_m_, preferred_mps_;
};

}  // namespace sidestep
