// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/vec2.hpp"
#include "vision/tracking/camera_offsets.hpp"
#include "vision/tracking/frame.hpp"

namespace sidestep {

/// Lets a robot move smoothly where it passes from the view of one camera to that of another. Cameras that
/// disagree would make it jump, until CameraOffsets has corrected them. A camera that begins to see the robot
/// is shifted, for this robot alone, by as much as it differs from the camera that has seen it until then.
/// The shift then fades as fast as corrections change. Allocates only in the constructor.
class CameraHandovers {
 public:
  /// `noise_m`: standard deviation of a robot's observed position on each axis. What it explains is no
  /// difference between cameras.
  explicit CameraHandovers(double noise_m);

  /// Shifts the robots of a usable frame that is already corrected by CameraOffsets. Removes robots whose
  /// shift is not yet known: it is after two comparisons that agree, in the camera's third frame, or in its
  /// fifth at the latest.
  void shift(Frame& frame);
  /// Lets shifts fade during this time.
  void advance(Duration elapsed);
  /// Forgets everything. Call it when the clock was set back.
  void forget();

 private:
  /// How a camera sees a robot.
  struct Sight {
    std::uint32_t camera = 0;
    int frames = 0;         ///< number of frames since the camera began to see the robot; 0: it does not
    CameraSighting latest;  ///< without the shift
    Vec2 shift_m{0, 0};
    bool is_known = false;           ///< whether shift_m is known
    std::optional<Vec2> compared_m;  ///< the shift by the last comparison with another camera
  };
  static constexpr std::size_t kMaxCameras = 4;  ///< number of cameras that see a robot at once
  using Sights = std::array<Sight, kMaxCameras>;

  static Sight& sight_of(Sights& sights, std::uint32_t camera, Time captured_at);
  void update(const Sights& sights, Sight& sight, const CameraSighting& now) const;

  double min_shift_m_;
  std::vector<Sights> robots_;  ///< indexed by robot
};

}  // namespace sidestep
