// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "simulator/rendering/scene.hpp"
#include "simulator/world.hpp"

namespace sidestep {

/// What stands on a floor at one moment.
struct FloorScene {
  std::vector<SceneRobot> robots;
  std::vector<SceneBlob> blobs;
  std::optional<SceneBall> ball;

  Scene scene() const { return {robots, blobs, ball}; }
};

/// What a scenario puts on the floor. Robots wear the pattern of their number.
FloorScene floor_scene(const Scenario& scenario);
/// What there is of it in the world by now.
FloorScene floor_scene(const Scenario& scenario, const World& world);

}  // namespace sidestep
