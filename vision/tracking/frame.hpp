// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/geometry/vec2.hpp"
#include "common/motion/version.hpp"
#include "common/time/time.hpp"
#include "idl/vision.h"

namespace sidestep {

struct RobotObservation {
  RobotId robot = 0;
  Vec2 position_m{0, 0};
  double heading_rad = 0;  ///< in [-pi, pi]
};

struct ObstacleObservation {
  Vec2 position_m{0, 0};
  double radius_m = 0;
};

/// Whether a capture time is one that frames may have which arrive now: from 500 ms ago to 100 ms ahead,
/// because cameras' clocks differ.
bool is_timely(std::int64_t captured_at_ns, Time now);

/// A DetectionFrame of which every number has been checked, and nothing else kept.
class Frame {
 public:
  std::uint32_t camera() const { return camera_; }
  Time captured_at() const { return captured_at_; }
  /// Not usable: its stamp or its counts made no sense, and it holds no detection.
  bool is_usable() const { return is_usable_; }
  std::span<const RobotObservation> robots() const { return {robots_.data(), robot_count_}; }
  std::span<const Vec2> balls() const { return {balls_.data(), ball_count_}; }
  std::span<const ObstacleObservation> obstacles() const { return {obstacles_.data(), obstacle_count_}; }
  /// Detections of the message that are not in here; for a frame that is not usable at least 1.
  std::uint64_t rejected() const { return rejected_; }

  /// Takes over what makes sense: timely stamps, positions within 100 m, confidences in 0..1, robot numbers
  /// below kMaxRobots, obstacles' radii up to 10 m. Allocates nothing.
  void assign(const msg::DetectionFrame& message, Time now);

 private:
  void clear(const msg::DetectionFrame& message);

  std::uint32_t camera_ = 0;
  Time captured_at_{};
  bool is_usable_ = false;
  std::size_t robot_count_ = 0;
  std::size_t ball_count_ = 0;
  std::size_t obstacle_count_ = 0;
  std::uint64_t rejected_ = 0;
  std::array<RobotObservation, kMaxRobots> robots_;
  std::array<Vec2, msg::MAX_DETECTED_BALLS> balls_;
  std::array<ObstacleObservation, msg::MAX_OBSTACLES> obstacles_;
};

}  // namespace sidestep
