// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "common/motion/version.hpp"
#include "deploy/trial/conformance/robot_probe.hpp"

namespace sidestep {

/// What vision sees of a robot that drives forwards along x and stops at the end of the last version sent to
/// it. All times are by the robot's clock.
class StopObservation {
 public:
  explicit StopObservation(const Version& last) : last_(last), seen_at_(last.trajectory.start()) {}

  /// Adds the samples in the order of their times.
  void add(const MotionSample& sample);
  /// Whether the robot should have come to rest and was seen there often enough, or vision has had time
  /// enough for that.
  bool is_over(Time robot_now) const;
  /// Why the stop cannot be judged; nullopt if it can be.
  std::optional<std::string> why_not_judged() const;

  const Trajectory& stop() const { return last_.trajectory; }
  /// Whether the robot replaced the last version by its own stop.
  bool has_own_stop() const { return executed_ > last_.number; }
  /// How far beyond its place of rest the robot was seen; 0 if it was not.
  double overshoot_m() const { return overshoot_m_; }
  /// Distance of the robot's mean position at rest from its place. Precondition: why_not_judged() is nullopt.
  double rest_error_m() const;

 private:
  /// From when on observations count as at rest.
  Time rests_from() const;

  Version last_;
  Time seen_at_;  ///< the latest observation of the stop, or the stop's start
  Duration longest_gap_{0};
  double overshoot_m_ = 0;
  Vec2 rest_sum_m_{0, 0};
  int rest_count_ = 0;
  VersionNumber executed_ = 0;  ///< at the latest observation
};

}  // namespace sidestep
