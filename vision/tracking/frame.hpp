// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/geometry/vec2.hpp"
#include "common/motion/safety_budget.hpp"
#include "common/motion/version.hpp"
#include "common/time/clock_bounds.hpp"
#include "idl/vision.hpp"

namespace sidestep {

struct RobotPoseObservation {
  RobotId robot = 0;
  Vec2 position_m{0, 0};
  double heading_rad = 0;  ///< in [-pi, pi]
};

struct ObstacleObservation {
  Vec2 position_m{0, 0};
  double radius_m = 0;
};

/// Default maximum by which a frame's capture time may be ahead of the local clock.
inline constexpr Duration kMaxFrameLead = max_vision_lead(max_clock_difference(SafetyBudget{}.clock_bound_s));

/// Whether a frame that arrives now may carry this capture time: at most 500 ms old, and at most `max_lead`
/// ahead, because clocks differ.
[[nodiscard]] bool is_timely(std::int64_t captured_at_ns, Time now, Duration max_lead = kMaxFrameLead);

/// Why a frame is unusable.
enum class FrameProblem : std::uint8_t {
  kNone,
  kTime,       ///< the capture time is too old or too far ahead
  kMalformed,  ///< a count or the obstacles' completeness is out of range
};

/// The valid content of a DetectionFrame: every number has been checked.
class Frame {
 public:
  std::uint32_t camera() const { return camera_; }
  Time captured_at() const { return captured_at_; }
  /// Maximum error of captured_at().
  Duration date_uncertainty() const { return date_uncertainty_; }
  /// False if the capture time, a count or the obstacles' completeness was invalid; the frame then contains
  /// no detections.
  bool is_usable() const { return problem_ == FrameProblem::kNone; }
  FrameProblem problem() const { return problem_; }
  std::span<const RobotPoseObservation> robots() const { return {robots_.data(), robot_count_}; }
  std::span<const Vec2> balls() const { return {balls_.data(), ball_count_}; }
  std::span<const ObstacleObservation> obstacles() const { return {obstacles_.data(), obstacle_count_}; }
  /// Every obstacle that the camera detected nearer than this to one of the frame's robots is in obstacles().
  /// It is 0 if an obstacle was rejected, because the rejected obstacle may be anywhere.
  double obstacles_complete_within_m() const { return obstacles_complete_within_m_; }
  /// Number of detections in the message that were rejected; at least 1 for an unusable frame.
  std::uint64_t rejected() const { return rejected_; }

  /// Copies the valid detections: timely frames, coordinates up to kMaxCoordinate_m, confidences in 0..1,
  /// robot numbers below kMaxRobots, obstacle radii up to 10 m. Allocates nothing.
  void assign(const msg::DetectionFrame& message, Time now, Duration max_lead = kMaxFrameLead,
              Duration date_uncertainty = Duration{0});
  /// Moves all detections.
  void translate(const Vec2& by_m);
  /// Calls `keep` with each robot, which it may change, and removes those for which it returns false.
  template <typename Keep>
  void keep_robots(Keep keep) {
    const auto begin = robots_.begin();
    const auto end = std::remove_if(begin, begin + static_cast<std::ptrdiff_t>(robot_count_),
                                    [&](RobotPoseObservation& robot) { return !keep(robot); });
    robot_count_ = static_cast<std::size_t>(end - begin);
  }

 private:
  void clear(const msg::DetectionFrame& message);

  std::uint32_t camera_ = 0;
  Time captured_at_{};
  Duration date_uncertainty_{0};
  FrameProblem problem_ = FrameProblem::kMalformed;
  std::size_t robot_count_ = 0;
  std::size_t ball_count_ = 0;
  std::size_t obstacle_count_ = 0;
  double obstacles_complete_within_m_ = 0;
  std::uint64_t rejected_ = 0;
  std::array<RobotPoseObservation, kMaxRobots> robots_;
  std::array<Vec2, msg::MAX_DETECTED_BALLS> balls_;
  std::array<ObstacleObservation, msg::MAX_OBSTACLES> obstacles_;
};

}  // namespace sidestep
