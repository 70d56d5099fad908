// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>

#include "common/motion/limits.hpp"
#include "deploy/conformance/robot_probe.hpp"

namespace sidestep {

/// Drives the robot by a stream of versions, each of which continues the last one and is sent in two cycles
/// at least, long enough before its start for the robot's lead.
class VersionStream {
 public:
  /// The acceleration to hold from a state and time on; it is reduced to what the limits and the field allow.
  using Policy = std::function<Vec2(const State& from, Time start)>;

  VersionStream(RobotProbe& probe, const Scenario& scenario);

  /// Once per cycle, before the probe sends its command: adds a version if one is due.
  void extend(const Policy& policy);
  /// Adds no more versions; the robot stops at the end of the last one. extend() goes on from there.
  void stop();
  /// As stop(), and what the robot executes by then is the next version's base.
  void forget();
  /// Whether the robot has executed all versions to their end.
  bool is_at_rest() const;
  /// The number of times that the robot did not execute a version of the stream.
  int broken() const { return broken_; }
  /// A version of this stream that starts after the robot's lead; its number is not used again.
  Version next(const Trajectory& trajectory);
  /// The version that the robot is expected to execute last.
  const std::optional<Version>& last() const { return last_; }
  /// How long before its start a version has to be sent.
  Duration notice() const;

 private:
  void resynchronise();

  RobotProbe& probe_;
  MotionLimits limits_;
  Field field_;
  double radius_m_;
  VersionNumber number_ = 0;
  std::optional<Version> last_;  ///< nullopt: begins with what the robot executes
  int broken_ = 0;
};

}  // namespace sidestep
