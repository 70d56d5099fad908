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

/// A camera's view of the scenario at the start.
inline Image rendered_start(const Scenario& scenario, const CameraModel& camera, const RenderSpec& spec,
                            std::uint64_t seed) {
  FrameRenderer renderer(camera, scenario.field, butterfly(), spec, Rng(seed));
  return renderer.render(floor_scene(scenario).scene());
}

inline DetectorSettings settings_of(const Scenario& scenario, const std::vector<ColourBox>& boxes) {
  DetectorSettings settings;
  settings.boxes = boxes;
  settings.layout = butterfly();
  for (const RobotSpec& robot : scenario.robots)
    settings.roster.push_back({robot.id, robot.team, *butterfly().find(number_in_team(robot.id))});
  return settings;
}

/// The number of robots found within 5 mm of their start positions.
inline std::size_t found_at_start(const Scenario& scenario, const msg::DetectionFrame& frame) {
  return static_cast<std::size_t>(std::ranges::count_if(scenario.robots, [&](const RobotSpec& robot) {
    return std::ranges::any_of(frame.robots(), [&](const msg::RobotDetection& detection) {
      return detection.robot() == robot.id &&
             (Vec2(detection.x_m(), detection.y_m()) - robot.start_m).norm() < 0.005;
    });
  }));
}

}  // namespace sidestep::test
