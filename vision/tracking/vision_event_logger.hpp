// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/log/log_event.hpp"
#include "common/motion/version.hpp"
#include "common/time/rate_limit.hpp"
#include "common/time/time.hpp"
#include "vision/tracking/camera_offsets.hpp"
#include "vision/tracking/frame.hpp"

namespace sidestep {

/// Reports cameras and robots that are lost or found again, and refused frames.
class VisionEventLogger {
 public:
  /// A camera that sends no usable frame for longer than this is lost.
  static constexpr Duration kCameraTimeout{500'000'000};
  /// How long a camera may take to send its first frame.
  static constexpr Duration kFirstFrameTimeout{3'000'000'000};

  /// Cameras that disagree by more than `max_disagreement_m` are a warning.
  VisionEventLogger(const EventReporter& events, const std::vector<std::uint32_t>& cameras,
                    double max_disagreement_m);

  /// Reports a frame from a camera that is not configured. The number of reports is limited, because a
  /// hostile sender may invent any number of cameras.
  void on_unknown_camera(std::uint32_t camera);
  /// Processes a frame of a configured camera, usable or not.
  void on_frame(const Frame& frame, Time now);
  /// Processes the tracked world; call it once per period.
  void update(const msg::WorldState& world, Time now);
  /// Reports how much cameras disagree, once it is known and when it changes.
  void update(std::span<const CameraDisagreement> pairs, Time now);

 private:
  /// Number of samples after which a disagreement is reported.
  static constexpr int kReportedSamples = 60;

  struct Camera {
    Time heard_at{};
    bool is_lost = false;
    std::uint64_t refused = 0;
    std::uint64_t next_report = 1;  // value of `refused` at which the next report is due
    bool is_missing = false;        // already reported that no usable frame has arrived yet
  };
  void report_missing(std::uint32_t number, Camera& camera, Time now);
  void report_refusal(const Frame& frame, Camera& camera, Time now);

  const EventReporter& events_;
  double max_disagreement_m_;
  /// Disagreement of each pair as reported; 0 if it is not corrected.
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> reported_m_;
  RateLimit pair_reports_{8, std::chrono::seconds(10)};
  std::map<std::uint32_t, Camera> cameras_;
  std::optional<Time> begin_;
  std::uint64_t unknown_ = 0, next_unknown_report_ = 1;
  std::array<bool, kMaxRobots> was_tracked_{}, was_lost_{}, is_tracked_{};
};

}  // namespace sidestep
