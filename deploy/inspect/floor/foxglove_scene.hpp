// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "deploy/inspect/floor/floor_state.hpp"

namespace sidestep {

/// An empty schema for the JSON messages below: Lichtblick and Foxglove know the message types by name.
inline constexpr const char* kJsonSchema = R"({"type":"object","properties":{}})";
inline constexpr const char *kSceneTopic = "scene_update", *kTransformsTopic = "transforms";
inline constexpr const char *kSceneType = "foxglove.SceneUpdate",
                            *kTransformsType = "foxglove.FrameTransforms";

/// The floor as a foxglove.SceneUpdate in JSON: robots, moving obstacles, the ball, and each robot's planned
/// stop. Everything is in the frame "floor".
[[nodiscard]] nlohmann::json scene_update(const FloorState& floor, double radius_m, Time now);

/// The robots' poses as foxglove.FrameTransforms in JSON, for example from "floor" to "robot 3".
[[nodiscard]] nlohmann::json frame_transforms(const FloorState& floor, Time now);

}  // namespace sidestep
