// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "tests/study/camera/camera_floor.hpp"
#include "tests/study/camera/pixel_guide.hpp"

namespace sidestep {

/// Events during a drive, at random times.
enum class DriveEvent {
  kNone,
  kTargetMoves,   ///< the target is moved twice
  kRobotPushed,   ///< the robot is displaced by 10 to 20 cm, twice
  kCameraBumped,  ///< the camera is turned by 0.5 to 3 degrees, and back after 1.5 seconds
};
inline constexpr std::array<const char*, 4> kDriveEventNames{"none", "target moves", "robot pushed",
                                                             "camera bumped"};

struct DriveResult {
  bool arrived = false;
  int contacts = 0;             ///< number of 1 ms steps in which the robot touched an obstacle
  int frames = 0;               ///< number of frames in the whole drive
  int replans = 0;              ///< number of plans after the first
  int unnecessary_replans = 0;  ///< number of replans before any event
  /// Number of frames in which the still camera was reported as moved.
  int false_alarms = 0;
  /// Number of frames from the bump to its detection; 1: the first frame.
  std::optional<int> noticed_after_frames;
  double blind_m = 0;  ///< distance driven from the bump until the robot was at rest
  StageTimes times;
  double cells_px = 0, diamonds_px = 0, discs_px = 0;  ///< lengths of the first paths; 0: no path
};

/// Drives a simulated robot guided by rendered images, 30 per second. All randomness depends on the seed.
[[nodiscard]] DriveResult drive(DriveEvent event, PixelPlanner planner, std::uint64_t seed);

}  // namespace sidestep
