// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/config/scenario.hpp"
#include "common/geometry/circle.hpp"
#include "common/geometry/vec3.hpp"
#include "common/image/colour_space.hpp"
#include "common/motion/rolling_ball.hpp"

namespace sidestep {

struct SceneRobot {
  Team team = Team::kBlue;
  std::uint32_t pattern = 0;  ///< id in the layout; a robot with an unknown id shows no dots
  Vec2 position_m{0, 0};
  double heading_rad = 0;
  Vec2 velocity_mps{0, 0};
  double angular_radps = 0;
  std::uint32_t hidden_dots =
      0;  ///< bit 0: the centre dot is covered; bit 1 + i: the layout's dot i is covered
};

/// A round object other than a marked robot: an obstacle, an opponent or a person.
struct SceneCylinder {
  Circle circle;
  double height_m = 0.15;
  Rgb colour{150, 96, 56};
  Vec2 velocity_mps{0, 0};
};

struct SceneBall {
  Vec3 position_m{0, 0, RollingBall::kRadius_m};  ///< position of the ball's centre
  Vec2 velocity_mps{0, 0};
};

/// The objects on the floor when a frame is captured.
struct Scene {
  std::span<const SceneRobot> robots;
  std::span<const SceneCylinder> cylinders{};
  std::optional<SceneBall> ball{};
};

}  // namespace sidestep
