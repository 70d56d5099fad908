// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/config/scenario.hpp"
#include "simulator/rendering/scene.hpp"
#include "simulator/rendering/static_obstacles.hpp"
#include "simulator/world/world.hpp"

namespace sidestep {

/// The objects on a floor at one time.
struct FloorScene {
  std::vector<SceneRobot> robots;
  std::vector<SceneCylinder> cylinders;
  std::optional<SceneBall> ball;

  Scene scene() const { return {robots, cylinders, ball}; }
};

/// The scenario's floor at the start. Each robot has the marker pattern of its number.
FloorScene floor_scene(const Scenario& scenario);
/// The floor in the world's current state.
FloorScene floor_scene(const Scenario& scenario, const World& world);

/// The scenario's map, and its obstacles except circles, which are cylinders of a FloorScene.
StaticScene static_scene(const Scenario& scenario);

}  // namespace sidestep
