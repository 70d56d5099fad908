// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_watch.hpp"

#include <algorithm>

namespace sidestep {

void CameraWatch::on_frame(std::uint32_t camera, Time captured_at) {
  if (count_ > 0 && camera >= count_) return;
  const auto found = cameras_.find(camera);
  if (found == cameras_.end() && cameras_.size() >= kMaxCameras) return;
  Camera& watched = cameras_[camera];
  if (captured_at <= watched.last) return;  // late
  if (captured_at - watched.last > kMaxGap) watched.frames = 0;
  watched.frames = std::min(watched.frames + 1, kFrames);
  watched.last = captured_at;
}

bool CameraWatch::watches(const Camera& camera, Time now) const {
  return camera.frames >= kFrames && now - camera.last <= kMaxAge;
}

bool CameraWatch::is_complete(Time now) const {
  std::size_t watching = 0, heard = 0;
  for (const auto& [number, camera] : cameras_) {
    heard += now - camera.last <= kForgetAfter;
    watching += watches(camera, now);
  }
  return count_ > 0 ? watching == count_ : watching > 0 && watching == heard;
}

}  // namespace sidestep
