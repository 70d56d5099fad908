// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/camera/camera_grid.hpp"
#include "common/config/scenario_loader.hpp"
#include "common/marking/butterfly.hpp"
#include "simulator/images/floor_scene.hpp"
#include "simulator/rendering/frame_renderer.hpp"
#include "vision/detection/detector.hpp"

namespace sidestep::test {

/// A small floor with six robots, a ball, an obstacle and an opponent, under one camera.
inline const std::string kFloorFile = SIDESTEP_SOURCE_DIR "/simulator/rendering/pictures/floor.yaml";

/// What a scenario's camera sees before anything moves.
inline Image rendered_start(const Scenario& scenario, const CameraModel& camera, const RenderSpec& spec,
                            std::uint64_t seed) {
  FrameRenderer renderer(camera, scenario.field, butterfly(), spec, Rng(seed));
  return renderer.render(floor_scene(scenario).scene());
}

inline FrameTask task_of(const Scenario& scenario, const std::vector<ColourBox>& boxes) {
  FrameTask task;
  task.boxes = boxes;
  task.layout = butterfly();
  for (const RobotSpec& robot : scenario.robots)
    task.roster.push_back({robot.id, robot.team, *butterfly().find(number_of(robot.id))});
  return task;
}

/// Of the scenario's robots, how many are found within 5 mm of where they start.
inline std::size_t found_at_start(const Scenario& scenario, const msg::DetectionFrame& frame) {
  return static_cast<std::size_t>(std::ranges::count_if(scenario.robots, [&](const RobotSpec& robot) {
    return std::ranges::any_of(frame.robots(), [&](const msg::RobotDetection& seen) {
      return seen.robot() == robot.id && (Vec2(seen.x_m(), seen.y_m()) - robot.start_m).norm() < 0.005;
    });
  }));
}

}  // namespace sidestep::test
