// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// Decides whether the cameras have watched the floor for long enough that every obstacle in their view has
/// been observed. Otherwise, for example after a pause of this process, there may be obstacles that have not
/// been seen. The set of cameras is configured, because a camera that has long been silent may still see an
/// obstacle.
class CameraWatch {
 public:
  /// Maximum time between the captures of consecutive frames of a watching camera.
  static constexpr Duration kMaxGap{300'000'000};
  /// Number of frames after a gap until a camera counts as watching again. Some of them may miss an obstacle.
  static constexpr int kFrames = 5;
  /// Maximum age of a watching camera's latest frame.
  static constexpr Duration kMaxAge{600'000'000};

  /// `cameras` are the numbers of the cameras that together see the whole floor.
  explicit CameraWatch(const std::vector<std::uint32_t>& cameras);

  bool has(std::uint32_t camera) const { return cameras_.contains(camera); }
  /// Precondition: has(camera).
  void on_frame(std::uint32_t camera, Time captured_at);
  /// Whether all cameras watch. False if there are no cameras.
  bool is_complete(Time now) const;
  /// Resets all cameras: each must send kFrames frames again, and frames with earlier capture times are no
  /// longer late.
  void forget();

 private:
  struct Camera {
    Time last{};
    int frames = 0;  ///< number of frames since the last gap, at most kFrames
  };

  std::map<std::uint32_t, Camera> cameras_;
};

}  // namespace sidestep
