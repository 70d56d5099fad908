// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "deploy/evaluation/study/camera/camera_floor.hpp"
#include "deploy/evaluation/study/camera/pixel_guide.hpp"

namespace sidestep {

/// What happens during a drive, at a random time.
enum class DriveEvent {
  kNone,
  kTargetMoves,   ///< the target is put elsewhere, twice
  kRobotPushed,   ///< the robot is displaced by 10 to 20 cm, twice
  kCameraBumped,  ///< the camera is turned by 0.5 to 3 degrees, and back after one and a half seconds
};
inline constexpr std::array<const char*, 4> kDriveEventNames{"none", "target moves", "robot pushed",
                                                             "camera bumped"};

struct DriveResult {
  bool arrived = false;
  int contacts = 0;                         ///< steps of 1 ms in which the robot touched an obstacle
  int frames = 0;                           ///< of the whole drive
  int replans = 0;                          ///< after the first plan
  int unnecessary_replans = 0;              ///< before anything happened
  int false_alarms = 0;                     ///< frames in which the unmoved camera was taken for moved
  std::optional<int> noticed_after_frames;  ///< from the bump to the frame that noticed it; 1: the first
  double blind_m = 0;                       ///< driven from the bump until the robot rested
  StageTimes times;
  double cells_px = 0, diamonds_px = 0, discs_px = 0;  ///< lengths of the first paths; 0: none
};

/// Drives a simulated robot by rendered images, 30 a second, from a seed.
[[nodiscard]] DriveResult drive(DriveEvent event, PixelPlanner planner, std::uint64_t seed);

}  // namespace sidestep
