// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/scene.hpp"

namespace sidestep {

/// Robots of both teams, drawn among all ids, and a ball: each sways and turns in a cell of its own, so that
/// none touches another.
class SwayingRobots {
 public:
  /// So many robots of each team, at most 16. Throws std::invalid_argument when there is no room for them.
  SwayingRobots(const Field& field, std::size_t each, Rng& rng);

  /// Where they are at a time, and how they move.
  std::vector<SceneRobot> robots_at(double time_s) const;
  SceneBall ball_at(double time_s) const;

 private:
  struct Sway {
    Vec2 middle_m, reach_m, radps, phase_rad;
    double heading_rad, angular_radps;

    Vec2 position_m(double time_s) const;
    Vec2 velocity_mps(double time_s) const;
  };
  std::vector<SceneRobot> worn_;  ///< who wears what
  std::vector<Sway> sways_;       ///< as worn_, and the ball's
};

}  // namespace sidestep
