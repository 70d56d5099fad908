// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/time/time.hpp"

namespace sidestep {

/// Whether the cameras have watched the floor for long enough that every obstacle in their view has been
/// observed. Otherwise, as after a pause of this process, obstacles may be there that nobody has seen. Which
/// cameras there are is configured: one that is not heard, for however long, may see an obstacle.
class CameraWatch {
 public:
  /// A camera watches while its frames are no farther apart than this, by their times of capture.
  static constexpr Duration kMaxGap{300'000'000};
  /// Frames after a gap until it watches again. An obstacle may be missed in some of them.
  static constexpr int kFrames = 5;
  /// How old its latest frame may be.
  static constexpr Duration kMaxAge{600'000'000};

  /// `cameras`: the numbers of those that together see all of the floor.
  explicit CameraWatch(const std::vector<std::uint32_t>& cameras);

  bool has(std::uint32_t camera) const { return cameras_.contains(camera); }
  /// Precondition: has(camera).
  void on_frame(std::uint32_t camera, Time captured_at);
  /// Whether all cameras watch. False if there is none.
  bool is_complete(Time now) const;
  /// Every camera has to watch anew, and earlier frames do not make later ones late.
  void forget();

 private:
  struct Camera {
    Time last{};
    int frames = 0;  ///< since the last gap, at most kFrames
  };

  std::map<std::uint32_t, Camera> cameras_;
};

}  // namespace sidestep
