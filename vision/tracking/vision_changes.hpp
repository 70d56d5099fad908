// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>

#include "common/log/log_event.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "vision/tracking/frame.hpp"

namespace sidestep {

/// Reports which cameras and robots are lost or back, and that frames are refused.
class VisionChanges {
 public:
  /// A camera that sends no usable frame for longer is lost.
  static constexpr Duration kCameraTimeout{500'000'000};
  /// A hostile sender may invent any number of cameras; those beyond are not observed.
  static constexpr std::size_t kMaxCameras = 64;

  explicit VisionChanges(const EventReporter& events) : events_(events) {}

  /// A frame that has arrived, usable or not.
  void on_frame(const Frame& frame, Time now);
  /// The tracked world; call it once per period.
  void update(const msg::WorldState& world, Time now);

 private:
  struct Camera {
    Time heard_at{};
    bool is_lost = false;
    std::uint64_t refused = 0;
    std::uint64_t next_report = 1;  // value of `refused` at which it is reported
  };
  void report_refusal(const Frame& frame, Camera& camera, Time now);

  const EventReporter& events_;
  std::map<std::uint32_t, Camera> cameras_;
  std::array<bool, kMaxRobots> was_tracked_{}, was_lost_{}, is_tracked_{};
};

}  // namespace sidestep
