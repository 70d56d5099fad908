// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/motion/version_set.hpp"
#include "common/protocol/robot_messages.hpp"

namespace sidestep {

/// The versions that the robot may be executing, now or later: the versions that the agent has forwarded,
/// corrected by the robot's reports.
class HeldVersions {
 public:
  /// The effect of a report.
  struct ReportEffect {
    bool is_late = false;     ///< the report changed nothing, because a later report was applied before
    bool is_unknown = false;  ///< the agent did not know the executed version, which is now the only one held
    bool has_switched = false;  ///< the robot has switched to another held version
    int lost = 0;               ///< number of forwarded versions that the robot did not activate
  };

  /// A version that starts farther ahead than this was proposed by a wrong clock. Agents do not wait for its
  /// start before they propose again.
  static constexpr Duration kMaxAhead{2'000'000'000};

  explicit HeldVersions(VersionNumber next_number) : next_number_(next_number) {}

  /// Begins with the version that the robot executes when it first acknowledges the agent.
  void begin(const RobotReport& robot_report);
  /// Applies a later report. `is_current`: it belongs to the robot's current incarnation.
  ReportEffect apply(const RobotReport& robot_report, bool is_current);
  /// Accepts the next report regardless of its time. Times of different incarnations cannot be compared.
  void forget_report_times() { latest_report_ = Time::min(); }
  /// Adds a granted version. Precondition: not is_full().
  void add(const Version& version) { versions_.add(version); }

  const VersionSet& versions() const { return versions_; }
  bool is_full() const { return versions_.is_full(); }
  /// Whether the robot executes a version; false before begin() and while the robot is off the floor.
  bool is_executing() const { return versions_.find(executing_) != nullptr; }
  /// The version that the robot executes according to its latest report. Precondition: is_executing().
  const Version& executing() const { return *versions_.find(executing_); }
  /// The version that the robot is expected to execute at a time. Precondition: is_executing().
  const Version& base_at(Time start) const;
  /// Start of the last version that the robot is expected to switch to, apart from versions beyond kMaxAhead.
  Time last_start(Time now) const;
  /// Whether the robot can still switch to a version that continues `base`.
  bool has_base(VersionNumber base) const;
  /// Whether there is a version to which the robot can no longer switch.
  bool has_unreachable() const;
  /// A new number, higher than the numbers of all versions of the robot.
  VersionNumber take_number() { return next_number_++; }
  VersionNumber next_number() const { return next_number_; }

 private:
  void continue_numbers_after(const Version& executing);

  VersionSet versions_;
  VersionNumber executing_ = 0;
  Time latest_report_{};  // by the robot's clock
  VersionNumber next_number_;
};

}  // namespace sidestep
