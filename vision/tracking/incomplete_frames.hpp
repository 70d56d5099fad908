// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vision/tracking/frame.hpp"

namespace sidestep {

/// The cameras whose last frame had more obstacles than were tracked, and the distances of the missing
/// obstacles from the frame's robots. These obstacles may have moved since, so the distance up to which the
/// tracks are complete shrinks as the frame ages.
class IncompleteFrames {
 public:
  /// `max_speed_mps` is an obstacle's maximum speed, `max_error_m` the maximum error of its observed
  /// position. A frame older than `max_age` is forgotten, like a track.
  IncompleteFrames(double max_speed_mps, double max_error_m, Duration max_age)
      : max_speed_mps_(max_speed_mps), max_error_m_(max_error_m), max_age_(max_age) {}

  /// Replaces the last frame of the same camera, unless that frame is newer. Precondition: every obstacle of
  /// the frame that is nearer than `complete_within_m` to one of the frame's robots is tracked. Allocates
  /// only for incomplete frames.
  void update(const Frame& frame, double complete_within_m);
  bool is_empty() const { return frames_.empty(); }
  void clear() { frames_.clear(); }
  /// A lower bound on the distance of missing obstacles from the robots at a time.
  [[nodiscard]] double complete_within_m(std::span<const Vec2> robots_m, Time t) const;

 private:
  struct IncompleteFrame {
    std::uint32_t camera = 0;
    Time captured_at{};
    Duration date_uncertainty{0};
    double complete_within_m = 0;
    std::vector<Vec2> robots_m;
  };

  double max_speed_mps_;
  double max_error_m_;
  Duration max_age_;
  std::vector<IncompleteFrame> frames_;  // at most one per camera
};

}  // namespace sidestep
