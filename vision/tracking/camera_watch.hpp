// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "common/time/time.hpp"

namespace sidestep {

/// Whether the cameras have watched the floor for long enough that every obstacle in their view has been
/// observed. Otherwise, as after a pause of this process, obstacles may be there that nobody has seen.
class CameraWatch {
 public:
  /// A camera watches while its frames are no farther apart than this, by their times of capture.
  static constexpr Duration kMaxGap{300'000'000};
  /// Frames after a gap until it watches again. An obstacle may be missed in some of them.
  static constexpr int kFrames = 5;
  /// How old its latest frame may be.
  static constexpr Duration kMaxAge{600'000'000};
  /// A camera that is not in `count` is forgotten after this time without a frame.
  static constexpr Duration kForgetAfter{2'000'000'000};

  /// `count`: the cameras 0 .. count - 1 see all of the floor; other cameras do not matter. 0: how many there
  /// are is not known, so those count that are heard.
  explicit CameraWatch(std::uint32_t count) : count_(count) {}

  void on_frame(std::uint32_t camera, Time captured_at);
  bool is_complete(Time now) const;

 private:
  static constexpr std::size_t kMaxCameras = 256;

  struct Camera {
    Time last{};
    int frames = 0;  ///< since the last gap, at most kFrames
  };
  bool watches(const Camera& camera, Time now) const;

  std::uint32_t count_;
  std::map<std::uint32_t, Camera> cameras_;
};

}  // namespace sidestep
