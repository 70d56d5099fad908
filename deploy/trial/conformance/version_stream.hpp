// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "common/motion/limits.hpp"
#include "deploy/trial/conformance/robot_probe.hpp"

namespace sidestep {

/// Drives the robot with a stream of versions, each of which continues the previous one. Each version is sent
/// in at least two cycles, and early enough for the robot's lead.
class VersionStream {
 public:
  /// Returns the acceleration to hold from a state and time on. It is reduced to what the limits and the
  /// field allow.
  using Policy = std::function<Vec2(const State& from, Time start)>;

  VersionStream(RobotProbe& probe, const Scenario& scenario);

  /// Call once per cycle before the probe sends its command. Adds a version if one is due.
  void extend(const Policy& policy);
  /// Stops adding versions, so that the robot stops at the end of the last one. extend() continues from
  /// there.
  void stop();
  /// Like stop(), but extend() then continues from the version that the robot is executing.
  void forget();
  /// Whether the robot has executed all versions to their end.
  bool is_at_rest() const;
  /// Number of times that the robot made its own stop instead of executing a version of the stream.
  int own_stops() const { return own_stops_; }
  /// Number of times that the robot did not execute a version of the stream and made no own stop: the version
  /// came too late or not at all.
  int late_versions() const { return late_versions_; }
  /// A version of this stream that starts after the robot's lead. Its number is not used again.
  Version next(const Trajectory& trajectory);
  /// The last version that the robot is expected to execute.
  const std::optional<Version>& last() const { return last_; }
  /// How long before its start a version must be sent.
  Duration notice() const;

 private:
  void resynchronise();

  RobotProbe& probe_;
  MotionLimits limits_;
  Field field_;
  double radius_m_;
  VersionNumber number_ = 0;
  std::optional<Version>
      last_;  ///< nullopt: the stream continues from the version that the robot is executing
  int own_stops_ = 0, late_versions_ = 0;
};

}  // namespace sidestep
