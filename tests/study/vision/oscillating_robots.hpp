// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/field.hpp"
#include "common/random/rng.hpp"
#include "simulator/rendering/scene.hpp"

namespace sidestep {

/// Robots of both teams with randomly chosen patterns, and a ball. Each oscillates and rotates in its own
/// cell of the field, so that none touches another.
class OscillatingRobots {
 public:
  /// At most 16 robots per team. Throws std::invalid_argument when the field is too small for them.
  OscillatingRobots(const Field& field, std::size_t robots_per_team, Rng& rng);

  /// Poses and velocities of the robots at a time.
  std::vector<SceneRobot> robots_at(double time_s) const;
  SceneBall ball_at(double time_s) const;

 private:
  struct Oscillation {
    Vec2 centre_m, amplitude_m, angular_frequency_radps, phase_rad;
    double heading_rad, angular_radps;

    Vec2 position_m(double time_s) const;
    Vec2 velocity_mps(double time_s) const;
  };
  std::vector<SceneRobot> robots_;         ///< only teams and patterns are set
  std::vector<Oscillation> oscillations_;  ///< in the same order as robots_, then the ball's
};

}  // namespace sidestep
