// SPDX-License-Identifier: Apache-2.0
#include "vision/tracking/camera_watch.hpp"

#include <algorithm>

namespace sidestep {

CameraWatch::CameraWatch(const std::vector<std::uint32_t>& cameras) {
  for (const std::uint32_t camera : cameras) cameras_.emplace(camera, Camera{});
}

void CameraWatch::on_frame(std::uint32_t camera, Time captured_at) {
  Camera& watched = cameras_.at(camera);
  if (captured_at <= watched.last) return;  // the frame arrived late
  if (captured_at - watched.last > kMaxGap) watched.frames = 0;
  watched.frames = std::min(watched.frames + 1, kFrames);
  watched.last = captured_at;
}

void CameraWatch::forget() {
  for (auto& [number, camera] : cameras_) camera = {};
}

bool CameraWatch::is_complete(Time now) const {
  const auto watches = [=](const auto& entry) {
    const Camera& camera = entry.second;
    return camera.frames >= kFrames && now - camera.last <= kMaxAge;
  };
  return !cameras_.empty() && std::ranges::all_of(cameras_, watches);
}

}  // namespace sidestep
