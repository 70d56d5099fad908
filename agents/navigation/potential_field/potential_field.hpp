// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "agents/navigation/free_space.hpp"

namespace sidestep {

struct PotentialFieldSettings {
  double reach_m = 0.5;  ///< obstacles farther away do not repel
  /// Force tangential to the nearest obstacle, as a fraction of the repulsive force; positive:
  /// counter-clockwise. It leads out of some local minima. It has no potential.
  double rotation = 0;
};

/// Why a descent ended.
enum class DescentEnd {
  kArrived,       ///< the robot is at the goal
  kLocalMinimum,  ///< the forces cancel: the robot hardly moves, although it is not at the goal
  kTouching,      ///< an obstacle is within the robot's radius
  kStepsSpent,    ///< the maximum number of steps was reached
};

struct Descent {
  DescentEnd end = DescentEnd::kStepsSpent;
  std::vector<Vec2> path_m;  ///< starts at the start position
};

/// The potential field of a goal and of obstacles (Khatib 1986; Latombe 1991, ch. 7): a force that pulls to
/// the goal, one that pushes away from the nearest obstacle, and one that pushes around it. The method is
/// local: it can get stuck in minima other than the goal, which it reports. For `FreeSpace` see BubbleBand;
/// nothing is masked. Distances to obstacles are measured from the robot's outline, a disc.
class PotentialField {
 public:
  /// Throws std::invalid_argument if the radius or a setting is out of range.
  explicit PotentialField(double robot_radius_m, const PotentialFieldSettings& settings = {});

  /// The force at a position with this free distance. The attractive part has the size of the distance to the
  /// goal in metres.
  Vec2 force(const Vec2& at_m, const Vec2& goal_m, const FreeDistance& free) const;
  /// The potential without the rotational force; infinite where the robot touches an obstacle.
  double potential(const Vec2& at_m, const Vec2& goal_m, const FreeDistance& free) const;

  /// Follows the force in steps until the robot arrives, touches an obstacle or makes no more progress. The
  /// result belongs to this object and is valid until the next call.
  template <typename FreeSpace>
  const Descent& descend(const Vec2& start_m, const Vec2& goal_m, const FreeSpace& free, int max_steps) {
    begin(start_m);
    while (!check_end(goal_m, max_steps)) {
      const Vec2 at = descent_.path_m.back();
      step(goal_m, free(at, 0));
    }
    return descent_;
  }

 private:
  void begin(const Vec2& start_m);
  /// Whether the descent has ended; if so, records why.
  bool check_end(const Vec2& goal_m, int max_steps);
  void step(const Vec2& goal_m, const FreeDistance& free);
  bool makes_progress() const;
  /// The distance between the robot's outline and the nearest obstacle.
  double gap_m(const FreeDistance& free) const { return free.distance_m - robot_radius_m_; }

  double robot_radius_m_;
  PotentialFieldSettings settings_;
  Descent descent_;
  bool is_touching_ = false;
};

}  // namespace sidestep
